import { describe, expect, it } from 'vitest';
import { fieldErrorsOf, RestError } from '../../../src/connection/rest_error';
import type { JsonObject } from '../../../src/protocol/rest_types';
import {
  connectOverrides,
  formOfLink,
  initialConnect,
  linkOf,
} from '../../../src/store/vehicle/vehicle_connect';

const form = (changes = {}) => ({ ...initialConnect().form, ...changes });
const kCourse = { flight: { course: {} }, duration_s: 100, start_s: 5 } as JsonObject;

describe('connecting to a vehicle', () => {
  it('puts addresses together and takes them apart', () => {
    for (const link of [
      'udp-listen:0.0.0.0:14550',
      'udp:127.0.0.1:14551',
      'tcp:[::1]:5760',
      'tcp-listen:localhost:5760',
      'serial:/dev/ttyUSB0:57600',
    ]) {
      expect(linkOf(form(formOfLink(link) ?? {}))).toBe(link);
    }
    expect(formOfLink('carrier pigeon')).toBeNull();
  });

  it('replaces the flight of any scenario', () => {
    const { overrides, errors } = connectOverrides(form({ kind: 'tcp', port: ' 5760 ' }), kCourse);
    expect(errors).toEqual([]);
    expect(overrides).toEqual({
      flight: { mavlink: { link: 'tcp:127.0.0.1:5760', read_only: true } },
      title: 'Vehicle at tcp:127.0.0.1:5760',
      duration_s: 86_400,
      start_s: 0,
    });
    const more = form({ readOnly: false, system: '3', geoid_separation_m: '-33.5' });
    expect(connectOverrides(more, { flight: { course: {} } }).overrides['flight']).toEqual({
      mavlink: { link: 'udp-listen:127.0.0.1:14550', system: 3, geoid_separation_m: -33.5 },
    });
  });

  it('changes only what differs where the scenario flies a vehicle', () => {
    const mavlink = { link: 'tcp:127.0.0.1:5760', read_only: false, system: 0, mission_file: 'm' };
    const own = form({ kind: 'tcp', port: '5760', readOnly: false });
    expect(connectOverrides(own, { flight: { mavlink } }).overrides).toEqual({});
    expect(connectOverrides({ ...own, system: '2' }, { flight: { mavlink } }).overrides).toEqual({
      'flight.mavlink.system': 2,
    });
  });

  it('names the field of an error', () => {
    const fields = (changes: object) =>
      connectOverrides(form(changes), kCourse).errors.map(({ field }) => field);
    expect(fields({ port: '70000' })).toEqual(['flight.mavlink.link']);
    expect(fields({ host: ' ' })).toEqual(['flight.mavlink.link']);
    expect(fields({ kind: 'serial', baud: 'fast' })).toEqual(['flight.mavlink.link']);
    expect(fields({ system: '256' })).toEqual(['flight.mavlink.system']);
    expect(fields({ geoid_separation_m: '' })).toEqual(['flight.mavlink.geoid_separation_m']);
    const forbidden = new RestError(403, 'forbidden', 'flight.mavlink: must be as in the file');
    expect(fieldErrorsOf(forbidden)).toEqual([
      { field: 'flight.mavlink', message: 'must be as in the file' },
    ]);
    expect(fieldErrorsOf(new Error('gone'))).toEqual([{ field: '', message: 'gone' }]);
  });
});
