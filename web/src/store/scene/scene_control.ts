// Steers the 3D view: its mode, the viewpoint of each mode, and what it shows.
import type { StreamClient } from '../../connection/stream_client';
import type { SceneMode, ScenePart, SceneView } from '../../protocol/messages';
import type { Store } from '../state';
import type { SceneEye, SceneLook, SceneOrbit } from './scene_look';
import { flown, freeFrom, limited } from './scene_look';

export class SceneControl {
  constructor(
    private readonly store: Store,
    private readonly client: StreamClient,
  ) {}

  /** Shows exactly this, as of an address or a stored layout. */
  apply(look: SceneLook): void {
    this.store.state.scene = look;
    this.send();
  }

  setMode(mode: SceneMode): void {
    const { state } = this.store;
    const { scene } = state;
    if (mode === 'free' && scene.mode !== 'free') {
      const { eye, orbit } = freeFrom(scene, state.playback?.truth ?? null, this.centre());
      scene.eye = eye;
      scene.orbits.free = orbit;
    }
    scene.mode = mode;
    this.send();
  }

  orbit(change: Partial<SceneOrbit>): void {
    const { scene } = this.store.state;
    scene.orbits[scene.mode] = limited(scene.mode, { ...scene.orbits[scene.mode], ...change });
    this.send();
  }

  /** Moves the viewpoint of the mode `free`. */
  fly(by: { ahead_m: number; right_m: number; up_m: number }): void {
    const { scene } = this.store.state;
    scene.eye = flown(scene.eye, scene.orbits.free, by);
    this.send();
  }

  toggleFollow(): void {
    const { scene } = this.store.state;
    if (scene.mode !== 'orbit' && scene.mode !== 'top') return;
    this.orbit({ follow: !scene.orbits[scene.mode].follow });
  }

  togglePart(part: ScenePart): void {
    const { scene } = this.store.state;
    const show = new Set(scene.show);
    if (!show.delete(part)) show.add(part);
    scene.show = show;
    this.send();
  }

  setSize(width_px: number, height_px: number): void {
    this.client.setView({ width_px, height_px });
  }

  /** The view as the server is asked for it, without its size. */
  view(): Omit<SceneView, 'width_px' | 'height_px'> {
    const { mode, orbits, eye, show } = this.store.state.scene;
    return { mode, ...orbits[mode], ...eye, show: [...show] };
  }

  private send(): void {
    this.client.setView(this.view());
    this.store.change('scene');
  }

  /** Of the box around the flight of the main run. */
  private centre(): SceneEye {
    const { truth } = this.store.state.data;
    const middle = (column: 'x_m' | 'y_m' | 'z_m') => {
      let [low, high] = [Infinity, -Infinity];
      for (const value of truth.column(column)) {
        low = Math.min(low, value);
        high = Math.max(high, value);
      }
      return low <= high ? (low + high) / 2 : 0;
    };
    return { x_m: middle('x_m'), y_m: middle('y_m'), z_m: middle('z_m') };
  }
}
