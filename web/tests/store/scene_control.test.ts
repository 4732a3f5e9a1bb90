import { beforeEach, describe, expect, it } from 'vitest';
import { Viewing } from '../support/viewing';

let viewing: Viewing;

beforeEach(() => {
  viewing = new Viewing();
});

describe('SceneControl', () => {
  it('keeps the viewpoint inside its limits and each mode its own', () => {
    viewing.scene.orbit({ elevation_deg: 200, distance_m: 1, azimuth_deg: -10 });
    expect(viewing.socket.last()).toMatchObject({
      mode: 'chase',
      elevation_deg: 90,
      distance_m: 5,
      azimuth_deg: 350,
    });
    viewing.scene.setMode('orbit');
    expect(viewing.store.state.sceneOrbits.orbit.distance_m).toBeGreaterThan(100);
  });
});
