// Connects to an autopilot: its address, and the scenario over whose world it flies.
import type { ConnectForm, LinkKind } from '../../store/vehicle/vehicle_connect';
import { kGeoid, kLink, kSystem, linkOf } from '../../store/vehicle/vehicle_connect';
import type { Topic } from '../../store/state';
import { closeTopmost } from '../commands/shortcuts';
import { h, rebuild, setText } from '../dom';
import type { Context, View } from '../view';

const kKinds: readonly { value: LinkKind; label: string; hint: string }[] = [
  {
    value: 'udp-listen',
    label: 'UDP, wait',
    hint: 'The vehicle or a router sends to this address',
  },
  { value: 'udp', label: 'UDP, send first', hint: 'Sends to this address and listens to it only' },
  { value: 'tcp', label: 'TCP, connect', hint: 'As to ArduPilot’s simulator, port 5760' },
  { value: 'tcp-listen', label: 'TCP, wait', hint: 'Waits for one connection at a time' },
  { value: 'serial', label: 'Serial', hint: 'A radio or a cable at the server' },
];

/** Fields with an error of their own below them. */
const kFields = [kLink, kSystem, kGeoid] as const;

export class ConnectDialog implements View {
  readonly root: HTMLElement;
  private readonly scenario = h('select', { id: 'connect-scenario' });
  private readonly kind = h(
    'select',
    { id: 'connect-kind' },
    ...kKinds.map(({ value, label }) => h('option', { value }, label)),
  );
  private readonly kindHint = h('div', { class: 'connect-hint' });
  private readonly host = input('connect-host', 'text', 'host or address', 'Host or address');
  private readonly port = input('connect-port', 'text', 'port', 'Port');
  private readonly device = input('connect-device', 'text', '/dev/ttyUSB0', 'Serial device');
  private readonly baud = input('connect-baud', 'text', 'baud', 'Baud rate');
  private readonly readOnly = h('input', { id: 'connect-read-only', type: 'checkbox' });
  private readonly system = input('connect-system', 'text', '0');
  private readonly geoid = input('connect-geoid', 'text', '0');
  private readonly link = h('code', { 'data-role': 'connect-link' });
  private readonly errors = new Map(
    kFields.map((field) => [
      field,
      h('div', { class: 'field-error', hidden: true, 'data-error-of': field }),
    ]),
  );
  private readonly rest = h('div', { class: 'form-errors', role: 'alert', hidden: true });
  private readonly button = h('button', { class: 'primary', type: 'submit' }, 'Connect');
  private readonly net: HTMLElement;
  private readonly serial: HTMLElement;

  constructor(private readonly context: Context) {
    this.net = h('span', { class: 'connect-address' }, this.host, ':', this.port);
    this.serial = h('span', { class: 'connect-address' }, this.device, 'at', this.baud);
    this.root = h(
      'div',
      {
        class: 'overlay',
        hidden: true,
        'data-panel': 'connect',
        'data-changes': true,
        onclick: (event: MouseEvent) => {
          if (event.target === this.root) this.context.connect.close();
        },
        onkeydown: (event: KeyboardEvent) => {
          if (event.key !== 'Escape') return;
          event.stopPropagation();
          closeTopmost(this.context);
        },
      },
      this.dialog(),
    );
    this.listen();
  }

  private dialog(): HTMLElement {
    const row = (label: string, hint: string, control: HTMLElement, unit = '') =>
      h(
        'div',
        { class: 'connect-row', title: hint },
        h('label', { for: control.id }, label),
        h(
          'div',
          { class: 'connect-control' },
          control,
          unit === '' ? null : h('span', { class: 'unit' }, unit),
        ),
      );
    const error = (field: (typeof kFields)[number]) => this.errors.get(field) ?? '';
    return h(
      'form',
      {
        class: 'connect',
        role: 'dialog',
        'aria-label': 'Connect to a vehicle',
        novalidate: true,
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          void this.context.connect.start();
        },
      },
      h('h2', {}, 'Connect to a vehicle'),
      row('Over', 'Scenario whose world, cameras and estimators are used', this.scenario),
      row('Link', 'How the server reaches the autopilot', this.kind),
      this.kindHint,
      h(
        'div',
        { class: 'connect-row' },
        h('span', {}, 'Address'),
        h('div', { class: 'connect-control' }, this.net, this.serial),
      ),
      error(kLink),
      row('Read only', 'Sends nothing, not even heartbeats', this.readOnly),
      row('System', 'System number; 0: the first autopilot that is heard', this.system),
      error(kSystem),
      row('Geoid', 'Height of the geoid above the ellipsoid at the place', this.geoid, 'm'),
      error(kGeoid),
      h('p', { class: 'connect-note' }, 'Opens ', this.link, ' on the server.'),
      this.rest,
      h(
        'div',
        { class: 'connect-buttons' },
        h(
          'button',
          { class: 'secondary', type: 'button', onclick: () => this.context.connect.close() },
          'Cancel',
        ),
        this.button,
      ),
    );
  }

  private listen(): void {
    const { connect } = this.context;
    const text = (control: HTMLInputElement, name: keyof ConnectForm) =>
      control.addEventListener('input', () => connect.set({ [name]: control.value }));
    text(this.host, 'host');
    text(this.port, 'port');
    text(this.device, 'device');
    text(this.baud, 'baud');
    text(this.system, 'system');
    text(this.geoid, 'geoid_separation_m');
    this.scenario.addEventListener('change', () => connect.set({ scenario: this.scenario.value }));
    this.kind.addEventListener('change', () => connect.set({ kind: this.kind.value as LinkKind }));
    this.readOnly.addEventListener('change', () =>
      connect.set({ readOnly: this.readOnly.checked }),
    );
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('launch') && !changed.has('lists') && !changed.has('connection')) return;
    const { connect, scenarios, connection } = this.context.store.state;
    const opens = this.root.hidden && connect.open;
    this.root.hidden = !connect.open;
    if (!connect.open) return;
    const { form, errors, starting } = connect;
    const flyable = scenarios?.filter(({ error }) => error === null) ?? [];
    rebuild(this.scenario, JSON.stringify(flyable), () =>
      flyable.map(({ name, title }) => h('option', { value: name }, title)),
    );
    this.scenario.value = form.scenario;
    this.kind.value = form.kind;
    setText(this.kindHint, kKinds.find(({ value }) => value === form.kind)?.hint ?? '');
    this.net.hidden = form.kind === 'serial';
    this.serial.hidden = form.kind !== 'serial';
    this.readOnly.checked = form.readOnly;
    const fields: [HTMLInputElement, string][] = [
      [this.host, form.host],
      [this.port, form.port],
      [this.device, form.device],
      [this.baud, form.baud],
      [this.system, form.system],
      [this.geoid, form.geoid_separation_m],
    ];
    for (const [control, value] of fields) if (control.value !== value) control.value = value;
    setText(this.link, linkOf(form));
    const owner = (field: string) =>
      kFields.find((own) => own === field) ?? (field.startsWith('flight.mavlink') ? kLink : null);
    for (const [field, place] of this.errors) {
      const own = errors.filter((error) => owner(error.field) === field);
      setText(place, own.map(({ message }) => message).join('\n'));
      place.hidden = own.length === 0;
    }
    const others = errors.filter((error) => owner(error.field) === null);
    setText(
      this.rest,
      others
        .map(({ field, message }) => (field === '' ? message : `${field}: ${message}`))
        .join('\n'),
    );
    this.rest.hidden = others.length === 0;
    this.button.disabled = starting || form.scenario === '' || connection.status !== 'open';
    setText(this.button, starting ? 'Connecting' : 'Connect');
    if (opens) this.host.focus();
  }
}

/** @param name  for screen readers, unless a label names it */
function input(id: string, type: string, placeholder: string, name?: string): HTMLInputElement {
  const typed = { autocomplete: 'off', spellcheck: 'false' };
  return h('input', { id, type, placeholder, ...typed, 'aria-label': name });
}
