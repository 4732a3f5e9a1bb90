// The cameras of the watched runs, read from their manifests.
import type { RestClient } from '../../connection/rest_client';
import type { Store } from '../state';
import type { WatchedRun } from '../watched_run';

export class Cameras {
  private readonly asked = new WeakSet<WatchedRun>();

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
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
    } catch {
      // Without a manifest the run has one unnamed camera, whose pictures still arrive.
    }
  }
}
