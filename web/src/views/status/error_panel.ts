// Errors of the estimates as scored by the server; the dashboard computes none.
import { canBeDrawn } from '../../store/alignment';
import { exportErrors } from '../../store/errors/error_export';
import type { TextFormat } from '../../store/table_text';
import { kTextFormats } from '../../store/table_text';
import type { ErrorRow, ErrorTable } from '../../store/errors/error_table';
import type { RunOutcome } from '../../store/errors/run_outcome';
import { kReading, runOutcome } from '../../store/errors/run_outcome';
import {
  alignmentModes,
  allMetrics,
  errorTable,
  joinedTables,
  texelsPerPixel,
  textureHint,
  textureLimited,
} from '../../store/errors/error_table';
import { formatNumber, kNothing } from '../../store/format';
import type { Run } from '../../protocol/rest_types';
import { withResults } from '../../store/runs/counted_results';
import type { State, Topic } from '../../store/state';
import type { Track } from '../../store/tracks';
import { tracksOf } from '../../store/tracks';
import type { WatchedRun } from '../../store/watched_run';
import { copyText } from '../clipboard';
import { kStateColours, trackColour } from '../colours';
import { h, rebuild, setAttribute, setText } from '../dom';
import type { Panel } from '../panel';
import { frameOf, makePanel } from '../panel';
import type { Context, View } from '../view';

export class ErrorPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly alignment = h('select', { id: 'alignment', 'aria-label': 'Alignment' });
  private readonly copy = h(
    'select',
    {
      id: 'copy-errors',
      'aria-label': 'Copy the errors',
      title: 'Copies the errors of all shown runs under every alignment',
    },
    h('option', { value: '' }, 'Copy'),
    ...kTextFormats.map((format) => h('option', { value: format }, format)),
  );
  private readonly compared = h('select', { id: 'compared' });
  private readonly table = h('table', { class: 'errors' });
  /** The outcome of a run is still on its way. */
  private reading = false;

  constructor(private readonly context: Context) {
    this.panel = makePanel('errors', 'Errors');
    this.root = this.panel.root;
    this.panel.tools.append(
      h('label', { for: 'alignment' }, 'Alignment'),
      this.alignment,
      this.copy,
    );
    const line = h('label', { class: 'compare-line' }, 'Compare with', this.compared);
    this.panel.body.append(line, this.table);
    this.compared.addEventListener('change', () => {
      const { value } = this.compared;
      void context.alignment.compare(value === '' ? null : value);
    });
    this.alignment.addEventListener('change', () => {
      void context.alignment.choose(this.alignment.value);
    });
    this.copy.addEventListener('change', () => void this.copyAs(this.copy.value as TextFormat));
  }

  update(changed: ReadonlySet<Topic>): void {
    const { state } = this.context.store;
    const read = this.reading && changed.has('playback');
    if (changed.has('metrics') || changed.has('run') || read) {
      this.drawModes(state);
      this.draw(state);
    }
    if (changed.has('playback')) this.drawStates(state);
    if (changed.has('playback') || changed.has('run')) {
      this.panel.showFrame(frameOf(state.playback));
    }
  }

  private drawModes(state: State): void {
    const modes = alignmentModes(allMetrics(state.watched));
    const shown = modes.length > 0 ? modes : [state.alignment];
    rebuild(this.alignment, shown.join(' '), () =>
      shown.map((mode) => h('option', { value: mode }, mode)),
    );
    this.alignment.value = state.alignment;
    rebuild(this.compared, shown.join(' '), () => [
      h('option', { value: '' }, 'no other alignment'),
      ...shown.map((mode) => h('option', { value: mode }, mode)),
    ]);
    this.compared.value = state.compared ?? '';
    this.compared.disabled = modes.length === 0;
    this.compared.title = 'A second alignment next to the first: dashed in plots and 3D view';
    this.alignment.disabled = modes.length === 0;
    const drawn = state.watched.some(({ metrics }) => canBeDrawn(metrics, state.alignment));
    this.alignment.title = drawn
      ? 'Alignment of the errors, the plots and the 3D view'
      : 'Alignment of the errors only: this run does not contain its transform';
  }

  private async copyAs(format: TextFormat): Promise<void> {
    this.copy.value = '';
    const { notices, store } = this.context;
    if (await copyText(exportErrors(store.state.watched, format))) {
      notices.info(`Errors copied as ${format}.`);
    } else {
      notices.error('The browser does not permit copying.');
    }
  }

  private draw(state: State): void {
    const { compared } = state;
    const modes = compared === null ? [state.alignment] : [state.alignment, compared];
    const estimates = tracksOf(state).filter(({ name }) => name !== '');
    const tracks = modes.flatMap((by, i) =>
      estimates.map((track) =>
        i === 0 ? track : { ...track, by, label: `${track.label} by ${by}` },
      ),
    );
    this.panel.showEmpty(emptyText(state, tracks.length));
    this.table.hidden = tracks.length === 0;
    const table = joinedTables(
      modes.flatMap((mode) => state.watched.map((one) => tableOf(one, mode))),
    );
    const scored = state.watched.some(({ metrics }) => metrics?.estimators !== undefined);
    this.copy.disabled = !scored;
    this.table.classList.toggle('many', tracks.length > 2);
    const outcomes = table.estimators.flatMap((one, i) => {
      const run = tracks[i]?.run;
      return run === undefined ? [] : [runOutcome(run, one)];
    });
    this.reading = outcomes.some(({ text }) => text === kReading);
    const textures = modes.flatMap(() => state.watched.map(textureOf));
    rebuild(this.table, JSON.stringify([table, tracks.map(headOf), textures, outcomes]), () => [
      h('thead', {}, headRow(tracks)),
      h(
        'tbody',
        {},
        stateRow(tracks),
        this.outcomeRow(outcomes, tracks),
        ...table.rows.map(({ cells, cellHints, bad, ...row }) =>
          tableRow(
            row,
            cells.map((cell, i) => figureCell(cell, cellHints[i] ?? '', bad?.[i] === true)),
          ),
        ),
        textureRow(textures),
      ),
    ]);
    setAttribute(this.table, 'data-alignment', scored ? state.alignment : null);
    this.drawStates(state);
  }

  private outcomeRow(outcomes: readonly RunOutcome[], tracks: readonly Track[]): HTMLElement {
    const row = {
      key: 'outcome',
      label: 'Outcome',
      unit: '',
      hint: 'For the whole flight. INIT_LATE: tracking started later than 10 s or a tenth of the flight',
    };
    return tableRow(
      row,
      outcomes.map(({ text, good }, i) => {
        if (good === null) return h('td', { class: 'pending', title: text }, text);
        const track = tracks[i];
        const run = withResults(track?.run ?? null);
        const unexplained = good || run === null || track?.by !== undefined;
        return h(
          'td',
          { class: good ? 'good' : 'bad', title: text },
          text,
          unexplained ? null : this.explainButton(run, track?.name ?? ''),
        );
      }),
    );
  }

  private explainButton(run: Run, estimator: string): HTMLElement {
    return h(
      'button',
      {
        class: 'explain',
        'data-role': 'explain-estimator',
        'data-changes': true,
        'data-of': `${run.id} ${estimator}`,
        title: `Find out why ${estimator} failed: fly it again with one cause changed at a time`,
        onclick: () => void this.context.studies.explain(run, estimator),
      },
      'Explain',
    );
  }

  private drawStates(state: State): void {
    for (const cell of this.table.querySelectorAll<HTMLElement>('[data-state-of]')) {
      const name = cell.dataset['stateOf'] ?? '';
      const watched = state.watchedRun(cell.dataset['run'] ?? '');
      const here = watched?.instant?.estimates[name]?.state ?? kNothing;
      setText(cell, here);
      cell.style.color = kStateColours[here] ?? '';
    }
  }
}

/** The score of a run, or the same table without figures. */
function tableOf({ run, metrics }: WatchedRun, alignment: string): ErrorTable {
  const names = run?.estimators ?? [];
  const empty = { estimators: Object.fromEntries(names.map((name) => [name, { outcome: '' }])) };
  const scored = metrics?.estimators !== undefined;
  return errorTable(scored ? metrics : empty, alignment, names);
}

function headOf(track: Track) {
  return [track.label, trackColour(track)];
}

function headRow(tracks: Track[]): HTMLElement {
  const heads = tracks.map((track) =>
    h('th', { scope: 'col', style: `color:${trackColour(track)}` }, track.label),
  );
  return h('tr', {}, h('th', {}), ...heads);
}

function stateRow(tracks: Track[]): HTMLElement {
  const row = { key: 'state', label: 'State here', unit: '', hint: 'At the playback cursor' };
  return tableRow(
    row,
    tracks.map(({ run, name }) => h('td', { 'data-state-of': name, 'data-run': run.id }, kNothing)),
  );
}

interface Texture {
  /** Number of its estimators. */
  columns: number;
  median: number | null;
  limited: boolean;
}

function textureOf({ run, metrics }: WatchedRun): Texture {
  const columns = run?.estimators.length ?? 0;
  return { columns, median: texelsPerPixel(metrics), limited: textureLimited(run, metrics) };
}

/** A value of the run, not of an estimator: one cell across its columns. */
function textureRow(textures: Texture[]): HTMLElement {
  const row = { key: 'texture', label: 'Texture', unit: 'texels/px', hint: 'Median of the run' };
  const cells = textures.flatMap(({ columns, median, limited }) => {
    if (columns === 0) return [];
    const badge = limited ? h('span', { class: 'chip small texture-limited' }, 'limited') : null;
    const title = limited ? textureHint(median) : row.hint;
    const className = limited ? 'bad' : '';
    return h(
      'td',
      { colspan: columns, title, class: className },
      badge,
      ` ${formatNumber(median, 2)}`,
    );
  });
  return tableRow(row, cells);
}

function figureCell(text: string, hint: string, bad: boolean): HTMLElement {
  return h('td', { class: bad ? 'bad' : '', title: hint === '' ? undefined : hint }, text);
}

function tableRow(
  row: Omit<ErrorRow, 'cells' | 'cellHints' | 'bad'>,
  cells: HTMLElement[],
): HTMLElement {
  const head = h('th', { scope: 'row', title: row.hint }, row.label);
  if (row.unit !== '') head.append(h('span', { class: 'unit' }, row.unit));
  return h('tr', { 'data-row': row.key }, head, ...cells);
}

function emptyText(state: State, estimates: number): string | null {
  if (state.runId === null) return 'Errors of the estimates appear here.';
  return state.run !== null && estimates === 0 ? 'This flight has no estimators.' : null;
}
