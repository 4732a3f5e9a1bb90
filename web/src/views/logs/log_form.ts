// How the chosen log is flown.
import { kEstimatorChoices } from '../../store/launch_form';
import { flyableSources } from '../../store/logs/log_flight';
import { viewerNote } from '../access';
import { h, rebuild, setText } from '../dom';
import type { Context } from '../view';

export class LogForm {
  readonly root: HTMLElement;
  private readonly source = h('select', { id: 'log-source' });
  private readonly world = h('select', { id: 'log-scenario' });
  private readonly from = numberInput('log-from', 'start');
  private readonly to = numberInput('log-to', 'end');
  private readonly smooth = h('input', { type: 'checkbox', id: 'log-smooth' });
  private readonly offset = h('input', { type: 'checkbox', id: 'log-offset' });
  private readonly rebase = h('input', { type: 'checkbox', id: 'log-rebase' });
  private readonly agl = numberInput('log-agl');
  private readonly turn = numberInput('log-turn');
  private readonly geoid = numberInput('log-geoid');
  private readonly boxes = kEstimatorChoices.map(({ value, label }) => ({
    box: h('input', { type: 'checkbox', value, 'data-log-estimator': value }),
    label,
  }));
  private readonly errors = h('div', { class: 'form-errors', role: 'alert' });
  private readonly button = h(
    'button',
    { class: 'primary', type: 'submit', 'data-changes': true },
    'Fly',
  );

  constructor(private readonly context: Context) {
    this.root = h(
      'form',
      {
        class: 'log-form',
        novalidate: true,
        onsubmit: (event: SubmitEvent) => {
          event.preventDefault();
          void context.logs.fly();
        },
      },
      ...this.rows(),
      this.errors,
      this.button,
      viewerNote("Flying a log needs the operator's address."),
    );
    this.listen();
  }

  private rows(): HTMLElement[] {
    const moved = 'Moves the flight to the middle of the scenario’s imagery';
    return [
      row('Truth', 'Stream of the positions', this.source),
      row('Slice', 'Times by the vehicle’s clock: drag in a plot', this.from, 'to', this.to, 's'),
      row('Smooth', 'One smooth motion without outliers and steps', this.smooth),
      row('Time offset', 'Estimate it between positions and attitudes', this.offset, 'estimated'),
      row('Over', 'Scenario whose world and cameras are used', this.world),
      row('Move there', moved, this.rebase),
      row('Lowest', 'Smallest height above the ground after the move', this.agl, 'm'),
      row('Turned', 'Turns the moved flight clockwise', this.turn, 'deg'),
      row('Geoid', 'Height of the geoid above the ellipsoid at the log’s place', this.geoid, 'm'),
      this.estimatorRow(),
    ];
  }

  private estimatorRow(): HTMLElement {
    const checks = this.boxes.map(({ box, label }) => h('label', { class: 'check' }, box, label));
    const made = row(
      'Estimators',
      'None = camera and truth only',
      h('div', { class: 'checks' }, ...checks),
    );
    made.toggleAttribute('data-changes', true);
    return made;
  }

  private listen(): void {
    const { logs } = this.context;
    const change = (control: HTMLElement, action: () => void) =>
      control.addEventListener('change', action);
    change(this.source, () => void logs.chooseSource(this.source.value));
    change(this.world, () => logs.set({ scenario: this.world.value }));
    change(this.smooth, () => logs.set({ smooth: this.smooth.checked }));
    change(this.offset, () => logs.set({ autoOffset: this.offset.checked }));
    change(this.rebase, () => logs.set({ rebase: this.rebase.checked }));
    // While it is typed: an error that goes away with the next click would move what is clicked.
    const type = (input: HTMLInputElement, action: () => void) =>
      input.addEventListener('input', action);
    type(this.agl, () => logs.set({ lowest_agl_m: this.agl.value }));
    type(this.turn, () => logs.set({ turn_deg: this.turn.value }));
    type(this.geoid, () => logs.set({ geoid_separation_m: this.geoid.value }));
    const time = (input: HTMLInputElement) =>
      input.value.trim() === '' || Number.isNaN(Number(input.value)) ? null : Number(input.value);
    type(this.from, () => logs.set({ from_s: time(this.from) }));
    type(this.to, () => logs.set({ to_s: time(this.to) }));
    const boxes = this.boxes.map(({ box }) => box);
    for (const box of boxes) {
      change(box, () =>
        logs.set({ estimators: boxes.filter((b) => b.checked).map((b) => b.value) }),
      );
    }
  }

  update(): void {
    const { logPage, scenarios, connection } = this.context.store.state;
    const { info, flight, flightErrors, starting } = logPage;
    this.fillSelects();
    setValue(this.from, flight.from_s === null ? '' : String(round(flight.from_s)));
    setValue(this.to, flight.to_s === null ? '' : String(round(flight.to_s)));
    setValue(this.agl, flight.lowest_agl_m);
    setValue(this.turn, flight.turn_deg);
    setValue(this.geoid, flight.geoid_separation_m);
    this.smooth.checked = flight.smooth;
    this.offset.checked = flight.autoOffset;
    this.offset.disabled = !flight.smooth;
    this.rebase.checked = flight.rebase;
    this.agl.disabled = !flight.rebase;
    this.turn.disabled = !flight.rebase;
    this.boxes.forEach(({ box }) => (box.checked = flight.estimators.includes(box.value)));
    const sources = info === null ? [] : flyableSources(info);
    const problems = flightErrors.map(({ field, message }) =>
      field === '' ? message : `${shortField(field)}: ${message}`,
    );
    if (info !== null && sources.length === 0) {
      problems.push('This log has no positions of a known place: it cannot be flown.');
    }
    setText(this.errors, problems.join('\n'));
    this.errors.hidden = problems.length === 0;
    const ready = info !== null && sources.length > 0 && (scenarios?.length ?? 0) > 0;
    this.button.disabled = !ready || starting || connection.status !== 'open';
    setText(this.button, starting ? 'Starting' : 'Fly');
  }

  private fillSelects(): void {
    const { logPage, scenarios } = this.context.store.state;
    const { info, flight } = logPage;
    const sources = info === null ? [] : flyableSources(info);
    rebuild(this.source, JSON.stringify([sources, info?.truth]), () => [
      h('option', { value: '' }, `Recommended (${info?.truth?.position ?? 'none'})`),
      ...sources.map((name) => h('option', { value: name }, name)),
    ]);
    this.source.value = flight.source;
    const flyable = scenarios?.filter(({ error }) => error === null) ?? [];
    rebuild(this.world, JSON.stringify(flyable), () =>
      flyable.map(({ name, title }) => h('option', { value: name }, title)),
    );
    this.world.value = flight.scenario;
  }
}

/** The part of a field's path that the viewer knows. */
function shortField(field: string): string {
  return field.replace(/^flight\.log\./, '');
}

function round(value: number): number {
  return Math.round(value * 100) / 100;
}

function numberInput(id: string, placeholder = ''): HTMLInputElement {
  return h('input', { id, type: 'number', step: 'any', placeholder, autocomplete: 'off' });
}

function setValue(input: HTMLInputElement, value: string): void {
  if (document.activeElement !== input && input.value !== value) input.value = value;
}

function row(label: string, hint: string, ...controls: (HTMLElement | string)[]): HTMLElement {
  const first = controls.find((control) => typeof control !== 'string' && control.id !== '');
  const id = typeof first === 'string' || first === undefined ? undefined : first.id;
  return h(
    'div',
    { class: 'log-field', title: hint },
    h('label', { for: id }, label),
    h(
      'div',
      { class: 'log-controls' },
      ...controls.map((control) =>
        typeof control === 'string' ? h('span', { class: 'unit' }, control) : control,
      ),
    ),
  );
}
