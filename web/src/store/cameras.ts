// The cameras of the watched run, read from its manifest.
import type { RestClient } from '../connection/rest_client';
import type { Store } from './state';

export class Cameras {
  private asked: string | null = null;

  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
  ) {}

  /** Reads them once per run. */
  async refresh(): Promise<void> {
    const { runId, playback } = this.store.state;
    if (runId === null) this.asked = null;
    // The manifest lists them before the first frame.
    if (runId === null || runId === this.asked || playback === null || playback.frame < 0) return;
    this.asked = runId;
    try {
      const { cameras } = await this.rest.manifest(runId);
      if (this.store.state.runId !== runId || cameras === undefined) return;
      this.store.state.cameras = cameras;
      this.store.change('cameras');
    } catch {
      // Without a manifest the run has one unnamed camera, whose pictures still arrive.
    }
  }
}
