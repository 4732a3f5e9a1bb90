// The viewpoint of the 3D view, stored separately for each mode.
import type { StreamClient } from '../connection/stream_client';
import type { SceneMode } from '../protocol/messages';
import type { SceneOrbit, Store } from './state';

const kDistanceRange_m = [5, 20000] as const;
const kElevationRange_deg = [-10, 90] as const;

export class SceneControl {
  constructor(
    private readonly store: Store,
    private readonly client: StreamClient,
  ) {}

  setMode(mode: SceneMode): void {
    const { state } = this.store;
    state.sceneMode = mode;
    this.client.setView({ mode, ...state.sceneOrbits[mode] });
    this.store.change('scene');
  }

  orbit(change: Partial<SceneOrbit>): void {
    const { state } = this.store;
    const orbit = { ...state.sceneOrbits[state.sceneMode], ...change };
    orbit.azimuth_deg = ((orbit.azimuth_deg % 360) + 360) % 360;
    orbit.elevation_deg =
      state.sceneMode === 'top' ? 90 : clamp(orbit.elevation_deg, kElevationRange_deg);
    orbit.distance_m = clamp(orbit.distance_m, kDistanceRange_m);
    state.sceneOrbits[state.sceneMode] = orbit;
    this.client.setView({ mode: state.sceneMode, ...orbit });
    this.store.change('scene');
  }

  toggleFollow(): void {
    const { state } = this.store;
    this.orbit({ follow: !state.sceneOrbits[state.sceneMode].follow });
  }

  setSize(width_px: number, height_px: number): void {
    this.client.setView({ width_px, height_px });
  }
}

function clamp(value: number, [low, high]: readonly [number, number]): number {
  return Math.min(high, Math.max(low, value));
}
