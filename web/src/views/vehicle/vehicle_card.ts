// State of a live vehicle at the cursor, over the 3D view.
import { vehicleAt, vehicleLines } from '../../store/vehicle/vehicle_status';
import type { Topic } from '../../store/state';
import { h, rebuild, setAttribute, setText } from '../dom';
import type { Context, View } from '../view';

/** A running flight that stands still for this long waits for its vehicle. */
const kQuiet_ms = 3000;

export class VehicleCard implements View {
  readonly root: HTMLElement;
  private readonly title = h('b', {});
  private readonly state = h('span', { class: 'vehicle-link', 'data-role': 'vehicle-link' });
  private readonly lines = h('dl', {});
  private t_ns = -1;
  private heard_ms = 0;

  constructor(private readonly context: Context) {
    this.root = h(
      'div',
      { class: 'vehicle-card', hidden: true, 'data-panel': 'vehicle' },
      h('div', { class: 'vehicle-title' }, this.title, this.state),
      this.lines,
    );
    window.setInterval(() => this.draw(), 1000);
  }

  update(changed: ReadonlySet<Topic>): void {
    if (changed.has('rows') || changed.has('playback') || changed.has('run')) this.draw();
  }

  private draw(): void {
    const { data, clock, main, run } = this.context.store.state;
    const t_ns = main?.instant?.t_ns ?? 0;
    if (t_ns !== this.t_ns) {
      this.t_ns = t_ns;
      this.heard_ms = performance.now();
    }
    const at = vehicleAt(data.vehicle, t_ns);
    this.root.hidden = at === null;
    if (at === null) return;
    const live = run?.status === 'running' && clock?.live === true;
    const quiet_ms = performance.now() - this.heard_ms;
    const silent = live && quiet_ms > kQuiet_ms;
    const connected = at.connected && !silent;
    setText(this.title, `Vehicle ${at.row.vehicle}`);
    const since = silent ? ` for ${Math.floor(quiet_ms / 1000)} s` : '';
    setText(this.state, connected ? 'connected' : `not heard${since}`);
    setAttribute(this.state, 'data-connected', String(connected));
    const lines = vehicleLines(at.row);
    rebuild(this.lines, JSON.stringify(lines), () =>
      lines.flatMap(({ key, label, text }) => [
        h('dt', {}, label),
        h('dd', { 'data-vehicle': key }, text),
      ]),
    );
  }
}
