import { describe, expect, it } from 'vitest';
import type { JsonObject } from '../../src/protocol/rest_types';
import {
  fieldOfError,
  fieldsOf,
  fieldText,
  overridesOf,
  withOverrides,
} from '../../src/store/launch_form';

const course: JsonObject = {
  seed: 1,
  world: { builtin: { seed: 3 } },
  flight: {
    course: { airspeed_m_s: 25, roll_rate_max_deg_s: 45, height_agl_m: 300, bank_max_deg: 45 },
  },
  estimators: [{ name: 'orb', type: 'feature', parameters: { features: 900 } }],
  pacing: 'lockstep',
};

function texts(document: JsonObject, changes: Record<string, string> = {}): Map<string, string> {
  const map = new Map(fieldsOf(document).map((field) => [field.path, fieldText(document, field)]));
  for (const [path, text] of Object.entries(changes)) map.set(path, text);
  return map;
}

describe('the launcher', () => {
  it('overrides nothing when nothing was changed', () => {
    expect(overridesOf(course, texts(course))).toEqual({ overrides: {}, errors: [] });
  });

  it('overrides what was changed, as numbers', () => {
    const { overrides } = overridesOf(
      course,
      texts(course, {
        'flight.course.airspeed_m_s': '10',
        duration_s: '20.5',
        pacing: 'real_time',
      }),
    );
    expect(overrides).toEqual({
      'flight.course.airspeed_m_s': 10,
      duration_s: 20.5,
      pacing: 'real_time',
    });
  });

  it('lets an airframe fly the course in wind and turbulence', () => {
    const flown: JsonObject = {
      ...course,
      flight: { course: { airspeed_m_s: 25, dynamics: 'coordinated', turbulence: 'none' } },
    };
    const { overrides, errors } = overridesOf(
      flown,
      texts(flown, {
        'flight.course.dynamics': 'piper_cub_third',
        'flight.course.turbulence': 'light',
        'flight.course.wind.speed_m_s': '5',
      }),
    );
    expect(errors).toEqual([]);
    expect(overrides).toEqual({
      'flight.course.dynamics': 'piper_cub_third',
      'flight.course.turbulence': 'light',
      'flight.course.wind.speed_m_s': 5,
    });
  });

  it('turns estimators off, and keeps the parameters of those that stay', () => {
    expect(overridesOf(course, texts(course, { estimators: '' })).overrides).toEqual({
      estimators: [],
    });
    expect(overridesOf(course, texts(course, { estimators: 'orb,drifting' })).overrides).toEqual({
      estimators: [
        { name: 'orb', type: 'feature', parameters: { features: 900 } },
        { name: 'drifting', type: 'drifting' },
      ],
    });
  });

  it('puts values into a document as the server does', () => {
    const document: JsonObject = { seed: 1, flight: { course: { airspeed_m_s: 15 } } };
    const changed = withOverrides(document, {
      'flight.course.airspeed_m_s': 25,
      'flight.course.wind.speed_m_s': 3,
      estimators: [],
    });
    expect(changed).toEqual({
      seed: 1,
      flight: { course: { airspeed_m_s: 25, wind: { speed_m_s: 3 } } },
      estimators: [],
    });
    expect(document).toEqual({ seed: 1, flight: { course: { airspeed_m_s: 15 } } });
  });

  it('distinguishes two estimators of the same type', () => {
    const orb = { name: 'orb', type: 'process', command: ['orb'] };
    const svo = { name: 'svo', type: 'process', command: ['svo'] };
    const doors: JsonObject = { ...course, estimators: [orb, svo] };
    expect(overridesOf(doors, texts(doors, {})).overrides).toEqual({});
    expect(overridesOf(doors, texts(doors, { estimators: 'svo' })).overrides).toEqual({
      estimators: [svo],
    });
  });

  it('rejects text that is not a number', () => {
    const { errors } = overridesOf(course, texts(course, { seed: '', 'world.builtin.seed': 'x' }));
    expect(errors.map(({ field }) => field)).toEqual(['seed', 'world.builtin.seed']);
  });

  it('shows only the fields that the scenario has', () => {
    const logged: JsonObject = { seed: 1, flight: { logged: { file: 'a.tum' } }, world: {} };
    expect(fieldsOf(logged).map(({ path }) => path)).toEqual([
      'seed',
      'duration_s',
      'pacing',
      'estimators',
    ]);
  });

  it('finds the field of an error, also of one inside it', () => {
    const fields = fieldsOf(course);
    const field = (path: string) => fieldOfError(fields, { field: path, message: '' })?.path;
    expect(field('seed')).toBe('seed');
    expect(field('estimators.0.type')).toBe('estimators');
    expect(field('camera.fov_deg')).toBeUndefined();
  });

  it('has a field for the link of a live vehicle only', () => {
    const live = { flight: { mavlink: { link: 'tcp:127.0.0.1:5760' } } };
    expect(fieldsOf(course).map(({ path }) => path)).not.toContain('flight.mavlink.link');
    expect(texts(live).get('flight.mavlink.link')).toBe('tcp:127.0.0.1:5760');
    const changed = texts(live, { 'flight.mavlink.link': 'udp:127.0.0.1:14550' });
    expect(overridesOf(live, changed).overrides).toEqual({
      'flight.mavlink.link': 'udp:127.0.0.1:14550',
    });
  });
});
