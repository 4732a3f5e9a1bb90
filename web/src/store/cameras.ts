// The cameras of the main run, read from its manifest.
import type { RestClient } from '../connection/rest_client';
import type { Store } from './state';
import type { WatchedRun } from './watched_run';

export class Cameras {
  private readonly asked = new WeakSet<WatchedRun>();

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
  ) {}

  /** Reads them once per run. */
  async refresh(): Promise<void> {
    const { main } = this.store.state;
    // The manifest lists them before the first frame.
    if (main === null || this.asked.has(main) || (main.instant?.frame ?? -1) < 0) return;
    this.asked.add(main);
    try {
      const { cameras } = await this.rest.manifest(main.id);
      if (cameras === undefined) return;
      main.cameras = cameras;
      this.store.change('cameras');
    } catch {
      // Without a manifest the run has one unnamed camera, whose pictures still arrive.
    }
  }
}
