// Connects to an autopilot by address and flies what it reports over the world of any scenario.
import type { RestClient } from '../../connection/rest_client';
import { fieldErrorsOf } from '../../connection/rest_error';
import type { FieldError } from '../../protocol/field_errors';
import type { Json, JsonObject } from '../../protocol/rest_types';
import { valueIn } from '../scenario/draft';
import type { Session } from '../session';
import type { Store } from '../state';

export type LinkKind = 'udp-listen' | 'udp' | 'tcp' | 'tcp-listen' | 'serial';

export interface ConnectForm {
  /** Gives the world, the cameras and all else. */
  scenario: string;
  kind: LinkKind;
  host: string;
  port: string;
  device: string;
  baud: string;
  readOnly: boolean;
  system: string;
  geoid_separation_m: string;
}

export interface ConnectState {
  open: boolean;
  form: ConnectForm;
  errors: FieldError[];
  starting: boolean;
}

export const kLink = 'flight.mavlink.link';
export const kSystem = 'flight.mavlink.system';
export const kGeoid = 'flight.mavlink.geoid_separation_m';

export function initialConnect(): ConnectState {
  return {
    open: false,
    form: {
      scenario: '',
      kind: 'udp-listen',
      host: '127.0.0.1',
      port: '14550',
      device: '/dev/ttyUSB0',
      baud: '57600',
      readOnly: true,
      system: '0',
      geoid_separation_m: '0',
    },
    errors: [],
    starting: false,
  };
}

/** The address as docs/LIVE.md has it. */
export function linkOf({ kind, host, port, device, baud }: ConnectForm): string {
  if (kind === 'serial') return `serial:${device.trim()}:${baud.trim()}`;
  return `${kind}:${host.trim()}:${port.trim()}`;
}

/** The form's fields of an address; null if it is none. */
export function formOfLink(link: string): Partial<ConnectForm> | null {
  const serial = /^serial:(.+):(\d+)$/.exec(link);
  if (serial !== null) {
    return { kind: 'serial', device: serial[1] ?? '', baud: serial[2] ?? '' };
  }
  const net = /^(udp-listen|udp|tcp|tcp-listen):(.+):(\d+)$/.exec(link);
  if (net === null) return null;
  return { kind: net[1] as LinkKind, host: net[2] ?? '', port: net[3] ?? '' };
}

/**
 * Overrides only what differs in a scenario that flies a vehicle already: a server may forbid
 * changes of the rest.
 */
export function connectOverrides(
  form: ConnectForm,
  document: JsonObject,
): { overrides: Record<string, Json>; errors: FieldError[] } {
  const errors: FieldError[] = [];
  const whole = (field: string, text: string, [low, high]: [number, number]): number => {
    const value = Number(text);
    if (!/^\s*\d+\s*$/.test(text) || value < low || value > high) {
      errors.push({ field, message: `must be a whole number from ${low} to ${high}` });
    }
    return value;
  };
  if (form.kind === 'serial') {
    if (form.device.trim() === '') errors.push({ field: kLink, message: 'needs a device' });
    if (!/^\s*\d+\s*$/.test(form.baud)) {
      errors.push({ field: kLink, message: 'the baud rate must be a whole number' });
    }
  } else {
    if (form.host.trim() === '') errors.push({ field: kLink, message: 'needs a host' });
    const port = Number(form.port);
    if (!/^\s*\d+\s*$/.test(form.port) || port < 1 || port > 65_535) {
      errors.push({ field: kLink, message: 'the port must be a whole number from 1 to 65535' });
    }
  }
  const system = whole(kSystem, form.system, [0, 255]);
  const geoid_m = Number(form.geoid_separation_m);
  if (form.geoid_separation_m.trim() === '' || !Number.isFinite(geoid_m)) {
    errors.push({ field: kGeoid, message: 'must be a number' });
  }
  const link = linkOf(form);
  const wanted: Record<string, [Json, Json]> = {
    link: [link, ''],
    read_only: [form.readOnly, false],
    system: [system, 0],
    geoid_separation_m: [geoid_m, 0],
  };
  const overrides: Record<string, Json> = {};
  const own = valueIn(document, 'flight.mavlink');
  if (own === undefined) {
    const mavlink: JsonObject = {};
    for (const [name, [value, usual]] of Object.entries(wanted)) {
      if (value !== usual) mavlink[name] = value;
    }
    overrides['flight'] = { mavlink };
    overrides['title'] = `Vehicle at ${link}`;
    // The scenario's own flight may be shorter, and begin later.
    if (document['duration_s'] !== undefined) overrides['duration_s'] = kLongest_s;
    if (document['start_s'] !== undefined) overrides['start_s'] = 0;
    return { overrides, errors };
  }
  for (const [name, [value, usual]] of Object.entries(wanted)) {
    const path = `flight.mavlink.${name}`;
    if ((valueIn(document, path) ?? usual) !== value) overrides[path] = value;
  }
  return { overrides, errors };
}

const kLongest_s = 86_400;

export class VehicleConnect {
  constructor(
    private readonly store: Store,
    private readonly rest: RestClient,
    private readonly session: Session,
    private readonly newKey: () => string,
  ) {}

  /** Opens the dialog with the launcher's scenario, and the address of its vehicle if it has one. */
  open(): void {
    const { scenarioName, scenarioDocument, scenarios } = this.store.state;
    const flyable = scenarios?.filter(({ error }) => error === null) ?? [];
    const { connect } = this;
    connect.open = true;
    connect.errors = [];
    const chosen = flyable.find(({ name }) => name === scenarioName) ?? flyable[0];
    connect.form.scenario = chosen?.name ?? '';
    const at = (path: string) =>
      scenarioDocument === null ? undefined : valueIn(scenarioDocument, path);
    const link = at(kLink);
    if (typeof link === 'string') {
      Object.assign(connect.form, formOfLink(link), {
        readOnly: at('flight.mavlink.read_only') === true,
      });
    }
    this.changed();
  }

  close(): void {
    this.connect.open = false;
    this.changed();
  }

  set(changes: Partial<ConnectForm>): void {
    Object.assign(this.connect.form, changes);
    this.connect.errors = [];
    this.changed();
  }

  async start(): Promise<void> {
    const { connect } = this;
    if (connect.starting || connect.form.scenario === '') return;
    connect.starting = true;
    connect.errors = [];
    this.changed();
    try {
      const document = await this.rest.scenario(connect.form.scenario);
      const { overrides, errors } = connectOverrides(connect.form, document);
      connect.errors = errors;
      if (errors.length === 0) {
        const run = await this.rest.startRun(connect.form.scenario, overrides, this.newKey());
        const { state } = this.store;
        state.runs = [run, ...(state.runs ?? []).filter(({ id }) => id !== run.id)];
        connect.open = false;
        this.session.selectRun(run.id);
        this.store.change('lists');
      }
    } catch (error) {
      connect.errors = fieldErrorsOf(error);
    }
    connect.starting = false;
    this.changed();
  }

  private get connect(): ConnectState {
    return this.store.state.connect;
  }

  private changed(): void {
    this.store.change('launch');
  }
}
