// Status and latest log lines of the estimators; a tab of the middle panel.
import { kStatusColumns, saidBy, statusRows } from '../../store/estimator_status';
import type { StatusRow } from '../../store/estimator_status';
import { formatTime } from '../../store/format';
import type { State } from '../../store/state';
import { tracksOf } from '../../store/tracks';
import { estimateColour, kStateColours, trackColour } from '../colours';
import { h, rebuild } from '../dom';

const kMostLines = 50;

export class EstimatorTable {
  readonly root: HTMLElement;
  private readonly table = h('table', { class: 'statuses' });
  private readonly said = h('ol', { class: 'log said' });

  constructor() {
    this.root = h('div', { class: 'estimator-statuses', hidden: true }, this.table, this.said);
  }

  draw(state: State): void {
    const rows = statusRows(state.run, state.statuses);
    const colours = rows.map(({ name }) => colourOf(state, name));
    rebuild(this.table, JSON.stringify([rows, colours]), () => [
      h('thead', {}, headRow()),
      h('tbody', {}, ...rows.flatMap((row, i) => bodyRows(row, colours[i] ?? ''))),
    ]);
    const lines = saidBy(state.data.log, kMostLines);
    rebuild(this.said, JSON.stringify([lines, state.offset_ns]), () =>
      lines.map(({ t_ns, level, source, text }) =>
        h(
          'li',
          { 'data-level': level },
          h('time', {}, formatTime(t_ns + state.offset_ns)),
          h('b', { style: `color:${colourOf(state, source)}` }, source),
          h('span', {}, text),
        ),
      ),
    );
  }
}

function colourOf(state: State, name: string): string {
  const track = tracksOf(state).find((one) => one.run === state.main && one.name === name);
  return track === undefined ? estimateColour(0) : trackColour(track);
}

function headRow(): HTMLElement {
  const heads = kStatusColumns.map(({ key, label, hint }) =>
    h('th', { scope: 'col', title: hint, 'data-column': key }, label),
  );
  return h('tr', {}, h('th', {}), h('th', { scope: 'col' }, 'State'), ...heads);
}

function bodyRows(row: StatusRow, nameColour: string): HTMLElement[] {
  const colour = kStateColours[row.state] ?? '';
  const cells = row.cells.map(({ column, text, hint, bad }) =>
    h('td', { 'data-column': column, title: hint, class: bad ? 'bad' : '' }, text),
  );
  const main = h(
    'tr',
    { 'data-status-of': row.name },
    h('th', { scope: 'row', style: `color:${nameColour}` }, row.name),
    h('td', { 'data-column': 'state', style: `color:${colour}` }, row.state),
    ...cells,
  );
  if (row.crash === null) return [main];
  const columns = kStatusColumns.length + 2;
  return [
    main,
    h('tr', { class: 'crash' }, h('td', { colspan: columns, class: 'bad' }, row.crash)),
  ];
}
