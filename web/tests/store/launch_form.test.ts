import { describe, expect, it } from 'vitest';
import courseText from '../../../scenarios/course.json?raw';
import type { JsonObject } from '../../src/protocol/rest_types';
import {
  fieldOfError,
  fieldsOf,
  fieldText,
  kUsualScenario,
  withFieldText,
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

/** The document after texts were typed into its fields. */
function typed(document: JsonObject, changes: Record<string, string>): JsonObject {
  return Object.entries(changes).reduce((changed, [path, text]) => {
    const field = fieldsOf(document).find((one) => one.path === path);
    if (field === undefined) throw new Error(`no field ${path}`);
    return withFieldText(changed, document, field, text);
  }, document);
}

describe('the launcher', () => {
  it('keeps room for the fields of the scenario that is shown first', () => {
    expect(fieldsOf(kUsualScenario)).toEqual(fieldsOf(JSON.parse(courseText) as JsonObject));
  });

  it('changes nothing while nothing else is typed', () => {
    const texts = fieldsOf(course).map((field) => [field.path, fieldText(course, field)] as const);
    expect(typed(course, Object.fromEntries(texts))).toBe(course);
  });

  it('takes what is typed, as numbers', () => {
    const changed = typed(course, {
      'flight.course.airspeed_m_s': '10',
      duration_s: '20.5',
      pacing: 'real_time',
    });
    expect(changed).toMatchObject({
      flight: { course: { airspeed_m_s: 10, height_agl_m: 300 } },
      duration_s: 20.5,
      pacing: 'real_time',
    });
    expect(course['pacing']).toBe('lockstep');
  });

  it('lets an airframe fly the course in wind and turbulence', () => {
    const flown: JsonObject = {
      ...course,
      flight: { course: { airspeed_m_s: 25, dynamics: 'coordinated', turbulence: 'none' } },
    };
    const changed = typed(flown, {
      'flight.course.dynamics': 'piper_cub_third',
      'flight.course.turbulence': 'light',
      'flight.course.wind.speed_m_s': '5',
    });
    expect(changed['flight']).toEqual({
      course: {
        airspeed_m_s: 25,
        dynamics: 'piper_cub_third',
        turbulence: 'light',
        wind: { speed_m_s: 5 },
      },
    });
  });

  it('removes what is optional when its field is emptied', () => {
    const flown: JsonObject = {
      ...course,
      duration_s: 20,
      flight: { course: { airspeed_m_s: 25, wind: { speed_m_s: 5, from_deg: 90 } } },
    };
    const calm = typed(flown, { 'flight.course.wind.speed_m_s': '', duration_s: '' });
    expect(calm).not.toHaveProperty('duration_s');
    expect(calm['flight']).toEqual({ course: { airspeed_m_s: 25 } });
    expect(typed(flown, { 'flight.course.wind.from_deg': '' })['flight']).toEqual({
      course: { airspeed_m_s: 25, wind: { speed_m_s: 5 } },
    });
  });

  it('turns estimators off and on again, and keeps their parameters', () => {
    const none = typed(course, { estimators: '' });
    expect(none['estimators']).toEqual([]);
    const both = [
      { name: 'orb', type: 'feature', parameters: { features: 900 } },
      { name: 'drifting', type: 'drifting' },
    ];
    expect(typed(course, { estimators: 'orb,drifting' })['estimators']).toEqual(both);
    const field = fieldsOf(course).find(({ kind }) => kind === 'estimators');
    if (field === undefined) throw new Error('no field of the estimators');
    expect(withFieldText(none, course, field, 'orb')['estimators']).toEqual([both[0]]);
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
    expect(typed(doors, { estimators: 'svo' })['estimators']).toEqual([svo]);
  });

  it('keeps text that is not a number, so that its error can be shown', () => {
    const changed = typed(course, { seed: '', 'world.builtin.seed': 'x' });
    expect(changed).toMatchObject({ seed: '', world: { builtin: { seed: 'x' } } });
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
    const changed = typed(live, { 'flight.mavlink.link': 'udp:127.0.0.1:14550' });
    expect(changed).toEqual({ flight: { mavlink: { link: 'udp:127.0.0.1:14550' } } });
  });
});
