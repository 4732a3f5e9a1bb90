import { beforeEach, describe, expect, it } from 'vitest';
import { playbackMessage } from '../../support/samples';
import { Viewing } from '../../support/viewing';

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
    expect(viewing.store.state.scene.orbits.orbit.distance_m).toBeGreaterThan(100);
  });

  it('shows and hides parts', () => {
    viewing.scene.togglePart('image');
    expect(viewing.socket.last()).toMatchObject({ type: 'view' });
    const shown = () => (viewing.socket.last() as { show?: string[] }).show;
    expect(shown()).toContain('image');
    viewing.scene.togglePart('image');
    expect(shown()).not.toContain('image');
    expect(shown()).toContain('ribbons');
  });

  it('flies on from where the view was', () => {
    viewing.watch();
    const pose = { x_m: 100, y_m: 200, z_m: 300, roll_deg: 0, pitch_deg: 0, yaw_deg: 90 };
    viewing.socket.receive(playbackMessage({ truth: pose }));
    viewing.scene.orbit({ azimuth_deg: 0, elevation_deg: 0, distance_m: 50 });
    viewing.scene.setMode('free');
    // Straight behind an aircraft that flies to the east: 50 m to the west, looking east.
    const { eye, orbits } = viewing.store.state.scene;
    expect(eye.x_m).toBeCloseTo(50, 6);
    expect(eye.y_m).toBeCloseTo(200, 6);
    expect(eye.z_m).toBeCloseTo(300, 6);
    expect(orbits.free.azimuth_deg).toBeCloseTo(90, 6);
    viewing.scene.fly({ ahead_m: 30, right_m: 7, up_m: 2 });
    expect(viewing.socket.last()).toMatchObject({ type: 'view', mode: 'free' });
    expect(viewing.store.state.scene.eye.x_m).toBeCloseTo(80, 6);
    expect(viewing.store.state.scene.eye.y_m).toBeCloseTo(193, 6);
    expect(viewing.store.state.scene.eye.z_m).toBeCloseTo(302, 6);
  });
});
