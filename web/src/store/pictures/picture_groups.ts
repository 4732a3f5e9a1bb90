// Which pictures show the same place: those of one camera. They are zoomed and marked together.
import type { WatchedRun } from '../watched_run';

/** The camera whose pictures are shown; null = the first, or of a run whose cameras are not known. */
export function shownCamera({ camera, cameras }: Pick<WatchedRun, 'camera' | 'cameras'>) {
  const known = cameras.some(({ name }) => name === camera);
  return known && camera !== cameras[0]?.name ? camera : null;
}

/** Key of the pictures of a camera; cameras of the same name in different runs share it. */
export function cameraGroup(camera: string | null): string {
  return camera === null ? 'camera' : `camera ${camera}`;
}
