// Errors of the estimates as scored by the server; the dashboard computes none.
import type { ErrorRow, ErrorTable } from '../store/error_table';
import { canBeDrawn } from '../store/alignment';
import {
  alignmentModes,
  errorTable,
  texelsPerPixel,
  textureHint,
  textureLimited,
} from '../store/error_table';
import { formatNumber, kNothing } from '../store/format';
import type { State, Topic } from '../store/state';
import { estimateColour, kStateColours } from './colours';
import { h, rebuild, setAttribute, setText } from './dom';
import type { Panel } from './panel';
import { frameOf, makePanel } from './panel';
import type { Context, View } from './view';

export class ErrorPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly alignment = h('select', { id: 'alignment', 'aria-label': 'Alignment' });
  private readonly table = h('table', { class: 'errors' });

  constructor(private readonly context: Context) {
    this.panel = makePanel('errors', 'Errors');
    this.root = this.panel.root;
    this.panel.tools.append(h('label', { for: 'alignment' }, 'Alignment'), this.alignment);
    this.panel.body.append(this.table);
    this.alignment.addEventListener('change', () => {
      void context.alignment.choose(this.alignment.value);
    });
  }

  update(changed: ReadonlySet<Topic>): void {
    const { state } = this.context.store;
    if (changed.has('metrics') || changed.has('run')) {
      void this.context.alignment.refresh();
      this.drawModes(state);
      this.draw(state);
    }
    if (changed.has('playback')) this.drawStates(state);
    if (changed.has('playback') || changed.has('run')) {
      this.panel.showFrame(frameOf(state.playback));
    }
  }

  private drawModes(state: State): void {
    const modes = alignmentModes(state.metrics);
    const shown = modes.length > 0 ? modes : [state.alignment];
    rebuild(this.alignment, shown.join(' '), () =>
      shown.map((mode) => h('option', { value: mode }, mode)),
    );
    if (!shown.includes(state.alignment)) state.alignment = shown[0] ?? state.alignment;
    this.alignment.value = state.alignment;
    this.alignment.disabled = modes.length === 0;
    const drawn = canBeDrawn(state.metrics, state.alignment);
    this.alignment.title = drawn
      ? 'Alignment of the errors, the plots and the 3D view'
      : 'Alignment of the errors only: this run does not contain its transform';
  }

  private draw(state: State): void {
    const names = state.run?.estimators ?? [];
    const scored = state.metrics?.estimators !== undefined;
    this.panel.showEmpty(emptyText(state));
    this.table.hidden = names.length === 0;
    const metrics = state.metrics ?? {};
    const table = errorTable(
      scored
        ? metrics
        : { estimators: Object.fromEntries(names.map((name) => [name, { outcome: '' }])) },
      state.alignment,
      names,
    );
    this.table.classList.toggle('many', names.length > 2);
    const texture = textureOf(state);
    rebuild(this.table, JSON.stringify([table, names, texture]), () => [
      h('thead', {}, headRow(table, names)),
      h(
        'tbody',
        {},
        stateRow(table),
        outcomeRow(table, scored),
        ...table.rows.map(({ cells, cellHints, ...row }) =>
          tableRow(
            row,
            cells.map((cell, i) => figureCell(cell, cellHints[i] ?? '')),
          ),
        ),
        textureRow(texture, names.length),
      ),
    ]);
    setAttribute(this.table, 'data-alignment', scored ? state.alignment : null);
    this.drawStates(state);
  }

  private drawStates(state: State): void {
    for (const cell of this.table.querySelectorAll<HTMLElement>('[data-state-of]')) {
      const name = cell.dataset['stateOf'] ?? '';
      const here = state.playback?.estimates[name]?.state ?? kNothing;
      setText(cell, here);
      cell.style.color = kStateColours[here] ?? '';
    }
  }
}

function headRow(table: ErrorTable, names: string[]): HTMLElement {
  const heads = table.estimators.map(({ name }) =>
    h('th', { scope: 'col', style: `color:${estimateColour(names.indexOf(name))}` }, name),
  );
  return h('tr', {}, h('th', {}), ...heads);
}

function stateRow(table: ErrorTable): HTMLElement {
  const row = { key: 'state', label: 'State here', unit: '', hint: 'At the playback cursor' };
  return tableRow(
    row,
    table.estimators.map(({ name }) => h('td', { 'data-state-of': name }, kNothing)),
  );
}

function outcomeRow(table: ErrorTable, scored: boolean): HTMLElement {
  const row = {
    key: 'outcome',
    label: 'Outcome',
    unit: '',
    hint: 'For the whole flight. INIT_LATE: tracking started later than 10 s or a tenth of the flight',
  };
  return tableRow(
    row,
    table.estimators.map(({ outcome, good }) =>
      scored
        ? h('td', { class: good ? 'good' : 'bad', title: outcome }, outcome)
        : h('td', { class: 'pending' }, 'not scored yet'),
    ),
  );
}

interface Texture {
  median: number | null;
  limited: boolean;
}

function textureOf({ run, metrics }: State): Texture {
  return { median: texelsPerPixel(metrics), limited: textureLimited(run, metrics) };
}

/** A value of the run, not of an estimator: one cell across all columns. */
function textureRow({ median, limited }: Texture, columns: number): HTMLElement {
  const row = { key: 'texture', label: 'Texture', unit: 'texels/px', hint: 'Median of the run' };
  const badge = limited ? h('span', { class: 'chip small texture-limited' }, 'limited') : null;
  const title = limited ? textureHint(median) : row.hint;
  const value = formatNumber(median, 2);
  return tableRow(row, [
    h('td', { colspan: columns, title, class: limited ? 'bad' : '' }, badge, ` ${value}`),
  ]);
}

function figureCell(text: string, hint: string): HTMLElement {
  return hint === '' ? h('td', {}, text) : h('td', { class: 'bad', title: hint }, text);
}

function tableRow(row: Omit<ErrorRow, 'cells' | 'cellHints'>, cells: HTMLElement[]): HTMLElement {
  const head = h('th', { scope: 'row', title: row.hint }, row.label);
  if (row.unit !== '') head.append(h('span', { class: 'unit' }, row.unit));
  return h('tr', { 'data-row': row.key }, head, ...cells);
}

function emptyText(state: State): string | null {
  if (state.runId === null) return 'Errors of the estimates appear here.';
  if (state.run?.estimators.length === 0) return 'This flight has no estimators.';
  return null;
}
