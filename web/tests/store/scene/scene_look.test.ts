import { describe, expect, it } from 'vitest';
import {
  flown,
  freeFrom,
  lookFrom,
  showText,
  usualLook,
  viewText,
} from '../../../src/store/scene/scene_look';

const kAircraft = { x_m: 10, y_m: 20, z_m: 300, roll_deg: 30, pitch_deg: 5, yaw_deg: 45 };
const kCentre = { x_m: 0, y_m: 0, z_m: 100 };

describe('the look of the 3D view in an address', () => {
  it('is not written as long as it is usual', () => {
    expect(viewText(usualLook())).toBe('');
    expect(showText(usualLook())).toBe('');
    expect(lookFrom('', '')).toEqual(usualLook());
  });

  it('comes back as it was', () => {
    const look = usualLook();
    look.mode = 'orbit';
    look.orbits.orbit = { azimuth_deg: 12.5, elevation_deg: -3, distance_m: 450, follow: false };
    look.show = new Set(['aircraft', 'image', 'error_history']);
    expect(viewText(look)).toBe('orbit,12.5,-3.0,450,fixed');
    expect(showText(look)).toBe('aircraft,error_history,image');
    expect(lookFrom(viewText(look), showText(look))).toEqual(look);
  });

  it('has the place of a free viewpoint', () => {
    const look = usualLook();
    look.mode = 'free';
    look.orbits.free = { ...look.orbits.free, azimuth_deg: 270, elevation_deg: -45 };
    look.eye = { x_m: -1200.5, y_m: 33, z_m: 410 };
    expect(viewText(look)).toBe('free,270.0,-45.0,-1200.5,33.0,410.0');
    expect(lookFrom(viewText(look), '')).toEqual(look);
  });

  it('can show nothing but the ground', () => {
    expect(showText({ show: new Set() })).toBe('none');
    expect(lookFrom('', 'none').show.size).toBe(0);
  });

  it.each([
    'sideways,1,2,3',
    'orbit,a,b,c',
    'orbit,1',
    'orbit,NaN,2,3',
    'free,1,2',
    'x'.repeat(500),
  ])('is as usual for %s', (view) => {
    expect(viewText(lookFrom(view, '')).split(',').length).toBeLessThan(7);
    expect(lookFrom(view, 'ribbons,nonsense').show).toEqual(new Set(['ribbons']));
  });

  it('keeps the limits of the viewpoint', () => {
    const { orbits } = lookFrom('orbit,-30,400,1', '');
    expect(orbits.orbit).toMatchObject({ azimuth_deg: 330, elevation_deg: 90, distance_m: 5 });
    expect(lookFrom('free,0,0,9e9,0,0', '').eye.x_m).toBe(1e6);
  });
});

describe('the free view', () => {
  it('begins where each other view was', () => {
    const look = usualLook();
    look.mode = 'orbit';
    look.orbits.orbit = { azimuth_deg: 90, elevation_deg: 30, distance_m: 100, follow: true };
    const orbit = freeFrom(look, kAircraft, kCentre);
    expect(orbit.eye.x_m).toBeCloseTo(10 + 100 * Math.cos(Math.PI / 6), 9);
    expect(orbit.eye.y_m).toBeCloseTo(20, 9);
    expect(orbit.eye.z_m).toBeCloseTo(350, 9);
    expect(orbit.orbit).toMatchObject({ azimuth_deg: 270, elevation_deg: -30 });
    look.mode = 'top';
    const top = freeFrom(look, kAircraft, kCentre);
    expect(top.eye).toEqual({ x_m: 0, y_m: 0, z_m: 2500 });
    expect(top.orbit.elevation_deg).toBe(-90);
    look.mode = 'onboard';
    const onboard = freeFrom(look, kAircraft, kCentre);
    expect(onboard.eye).toEqual({ x_m: 10, y_m: 20, z_m: 301 });
    expect(onboard.orbit).toMatchObject({ azimuth_deg: 45, elevation_deg: -7 });
  });

  it('flies along the line of sight', () => {
    const down = { azimuth_deg: 0, elevation_deg: -90, distance_m: 5, follow: true };
    const eye = flown({ x_m: 0, y_m: 0, z_m: 100 }, down, { ahead_m: 10, right_m: 3, up_m: 0 });
    expect(eye.x_m).toBeCloseTo(3, 9);
    expect(eye.y_m).toBeCloseTo(0, 9);
    expect(eye.z_m).toBeCloseTo(90, 9);
  });
});
