// What differs between the runs that are shown together: scenario, parameters, program.
import { distinguishingNames } from '../../store/run_names';
import { DifferenceReader } from '../../store/runs/difference_reader';
import type { State, Topic } from '../../store/state';
import { runLetter } from '../../store/tracks';
import { h, rebuild } from '../dom';
import type { Panel } from '../panel';
import { makePanel } from '../panel';
import type { Context, View } from '../view';

export class DifferencesPanel implements View {
  readonly root: HTMLElement;
  private readonly panel: Panel;
  private readonly table = h('table', { class: 'differences' });
  private readonly more = h('p', { class: 'hint' });
  private readonly reader: DifferenceReader;

  constructor(private readonly context: Context) {
    this.panel = makePanel('differences', 'Differences');
    this.panel.body.append(this.table, this.more);
    this.root = this.panel.root;
    this.reader = new DifferenceReader(context.rest, () => this.draw(context.store.state));
  }

  update(changed: ReadonlySet<Topic>): void {
    if (!changed.has('run') && !changed.has('lists')) return;
    const { watched } = this.context.store.state;
    const states = watched.map(({ run }) => run?.status ?? '').join(' ');
    this.reader.show(
      watched.map(({ id }) => id),
      states,
    );
    this.draw(this.context.store.state);
  }

  onHidden(): void {
    this.reader.hide();
  }

  private draw(state: State): void {
    const { answer } = this.reader;
    const { watched } = state;
    const several = watched.length > 1;
    const known = several && answer !== null && typeof answer !== 'string' ? answer : null;
    const names = distinguishingNames(watched.flatMap(({ run }) => run ?? []));
    const heads = watched.map((one) => ({
      letter: runLetter(state, one),
      name: names.get(one.id) ?? one.id,
    }));
    rebuild(this.table, JSON.stringify([known, heads]), () => {
      if (known === null || known.fields.length === 0) return [];
      const head = heads.map(({ letter, name }) =>
        h('th', { scope: 'col', title: name }, h('b', { class: 'run-letter' }, letter), ` ${name}`),
      );
      const rows = known.fields.map(({ field, values }) =>
        h(
          'tr',
          {},
          h('th', { scope: 'row', title: field }, field),
          ...values.map((value) =>
            value === null
              ? h('td', { class: 'absent' }, '(absent)')
              : h('td', { title: value }, value),
          ),
        ),
      );
      return [
        h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'Field'), ...head)),
        h('tbody', {}, ...rows),
      ];
    });
    this.more.hidden = known === null || known.left_out === 0;
    this.more.textContent = known === null ? '' : `${known.left_out} more fields differ.`;
    this.panel.showEmpty(emptyText(several, answer, known?.fields.length ?? 0));
  }
}

function emptyText(several: boolean, answer: DifferenceReader['answer'], fields: number) {
  if (!several) return 'Show at least two runs together: press + in the list of runs.';
  if (answer === null) return 'Comparing the runs';
  if (typeof answer === 'string') return answer;
  return fields > 0 ? null : 'Nothing: scenario, parameters, world and program are the same.';
}
