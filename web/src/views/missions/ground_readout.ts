// Latitude, longitude and height of the ground under the mouse.
import type { RestClient } from '../../connection/rest_client';
import { formatNumber } from '../../store/format';
import { h, setText } from '../dom';

const kPause_ms = 120;

export class GroundReadout {
  readonly root = h('div', { class: 'mission-ground', 'data-role': 'ground-readout' });
  private world: string | null = null;
  private place: [number, number] | null = null;
  private waiting = 0;
  private asking = new AbortController();

  constructor(private readonly rest: Pick<RestClient, 'heights'>) {}

  setWorld(name: string | null): void {
    this.world = name;
  }

  hover(place: [number, number] | null): void {
    this.place = place;
    clearTimeout(this.waiting);
    this.asking.abort();
    this.show(null);
    if (place !== null) this.waiting = window.setTimeout(() => void this.ask(place), kPause_ms);
  }

  private async ask(place: [number, number]): Promise<void> {
    const { world } = this;
    if (world === null) return;
    const asking = new AbortController();
    this.asking = asking;
    try {
      const heights = await this.rest.heights(world, [place], asking.signal);
      if (this.place === place) {
        this.show(heights.imagery[0] === true ? (heights.alt_ellipsoid_m[0] ?? null) : null);
      }
    } catch {
      // Without the height the place is shown alone.
    }
  }

  private show(ground_m: number | null): void {
    const { place } = this;
    if (place === null) {
      setText(this.root, '');
      return;
    }
    const where = `${place[0].toFixed(6)}, ${place[1].toFixed(6)}`;
    const height = ground_m === null ? '' : ` · ground ${formatNumber(ground_m, 1)} m (ellipsoid)`;
    setText(this.root, where + height);
  }
}
