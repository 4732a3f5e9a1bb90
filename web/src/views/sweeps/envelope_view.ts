// How far along an axis of a sweep an estimator survives, a line for each combination of the others.
import type { Json } from '../../protocol/rest_types';
import type { Envelope, SweepState } from '../../protocol/sweep_types';
import { valueText } from '../../store/sweeps/sweep_matrix';
import { h, rebuild } from '../dom';

type Line = NonNullable<Envelope['lines']>[number];

export class EnvelopeView {
  readonly root = h('section', {
    class: 'sweep-envelope',
    'aria-label': 'Border of survival',
    hidden: true,
  });

  draw(shown: SweepState | null): void {
    const envelope = shown?.envelope ?? null;
    this.root.hidden = envelope === null;
    if (shown === null || envelope === null) return;
    rebuild(this.root, JSON.stringify([envelope, shown.sweep.axes]), () => [
      h('h3', {}, `Border of survival of ${envelope.estimator} along ${envelope.label}`),
      ...(envelope.lines === null
        ? [h('p', { class: 'muted' }, 'It is found when all lines are over.')]
        : foundParts(shown, envelope, envelope.lines)),
    ]);
  }
}

function foundParts({ sweep }: SweepState, envelope: Envelope, lines: Line[]): HTMLElement[] {
  const others = sweep.axes.filter(({ name }) => name !== envelope.axis);
  const { unit, cells, cells_needed } = envelope;
  const titles = [
    ...others.map((axis) => (axis.unit === '' ? axis.label : `${axis.label} [${axis.unit}]`)),
    'Survives at',
    'Fails at',
  ];
  const value = (one: Json) => (one === null ? 'nowhere' : valueText(one, unit));
  return [
    h(
      'table',
      { class: 'errors' },
      h('thead', {}, h('tr', {}, ...titles.map((text) => h('th', { scope: 'col' }, text)))),
      h(
        'tbody',
        {},
        ...lines.map(({ at, survives, fails, irregular }) =>
          h(
            'tr',
            {},
            ...others.map(({ name }) => h('th', { scope: 'row' }, valueText(at[name] ?? null, ''))),
            h('td', { class: 'good' }, value(survives)),
            h('td', { class: 'bad' }, value(fails)),
            ...(irregular ? [h('td', { class: 'muted' }, 'survival does not end once')] : []),
          ),
        ),
      ),
    ),
    h(
      'p',
      { class: 'muted' },
      `The last value that survives and the next one, which fails. ${cells_needed} of ${cells} cells were needed.`,
    ),
  ];
}
