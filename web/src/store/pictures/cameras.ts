// The cameras of the watched runs, read from their manifests.
import type { RestClient } from '../../connection/rest_client';
import { isPassing } from '../../connection/rest_error';
import type { Store } from '../state';
import type { WatchedRun } from '../watched_run';

const kRetry_ms = 5000;

export class Cameras {
  private readonly asked = new WeakSet<WatchedRun>();

  constructor(
    private readonly store: Store,
    private readonly rest: Pick<RestClient, 'manifest'>,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {}

  /** Reads them once per run. */
  async refresh(): Promise<void> {
    await Promise.all(this.store.state.watched.map((watched) => this.read(watched)));
  }

  private async read(watched: WatchedRun): Promise<void> {
    // The manifest lists them before the first frame.
    if (this.asked.has(watched) || (watched.instant?.frame ?? -1) < 0) return;
    this.asked.add(watched);
    try {
      const { cameras, estimators } = await this.rest.manifest(watched.id);
      if (cameras === undefined) return;
      watched.cameras = cameras;
      watched.estimatorCameras = new Map(
        (estimators ?? []).flatMap(({ name, camera }) =>
          camera === undefined ? [] : [[name, camera]],
        ),
      );
      this.store.change('cameras');
    } catch (error) {
      // Without a manifest the run has one unnamed camera, whose pictures still arrive.
      if (isPassing(error)) this.later(() => this.readAgain(watched), kRetry_ms);
    }
  }

  private readAgain(watched: WatchedRun): void {
    this.asked.delete(watched);
    void this.refresh();
  }
}
