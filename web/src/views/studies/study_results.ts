// What a study has found: causes with their flights, risky parts with the page, hunted flights.
import type {
  Explanation,
  HuntedFlight,
  HuntResult,
  Prediction,
  Reflight,
  StudyShown,
} from '../../protocol/study_types';
import type { Json } from '../../protocol/rest_types';
import { formatNumber, formatPercent, kNothing } from '../../store/format';
import {
  bandsOf,
  causeRows,
  huntedText,
  huntSentence,
  plainWords,
  reflightText,
  severityOf,
  spanOf,
} from '../../store/studies/study_words';
import { download } from '../download';
import { h } from '../dom';
import type { Context } from '../view';

/** @returns the elements of a result, none before there is one */
export function resultParts(context: Context, shown: StudyShown): HTMLElement[] {
  const { study, result } = shown;
  if (result === null) return [];
  switch (study.kind) {
    case 'explain':
      return explanationParts(context, study.name, result as Explanation);
    case 'predict':
      return predictionParts(context, study.name, result as Prediction);
    case 'hunt':
      return huntParts(context, study.name, result as HuntResult);
  }
}

// ---- explanation -------------------------------------------------------------------------------

function explanationParts(context: Context, name: string, explanation: Explanation): HTMLElement[] {
  const rows = causeRows(explanation);
  const causes = rows.map(({ words, necessary, sufficient, margin }) =>
    h(
      'tr',
      { 'data-cause': words },
      h('th', { scope: 'row' }, words),
      verdictCell(necessary),
      verdictCell(sufficient),
      h('td', {}, margin === '' ? kNothing : margin),
    ),
  );
  const untried = explanation.untried.map(({ cause, reason }) =>
    h('li', {}, `${plainWords(explanation.words[cause] ?? cause)}: ${reason}`),
  );
  return [
    sentences(explanation.sentences),
    ...(causes.length === 0
      ? []
      : [
          table(
            'Causes',
            'study-causes',
            [
              ['Cause', ''],
              ['Necessary', 'Without it the estimator survives'],
              ['Sufficient', 'With everything else taken away it still fails'],
              ['Margin', 'How much of it is survived'],
            ],
            causes,
          ),
        ]),
    table(
      'Flights',
      'study-flights',
      [
        ['Flight', ''],
        ['Result', 'Times count from the start of the part that was flown'],
        ['From the start to the failure', 'Initialising, tracking, lost, by the time of the run'],
        ['Part [s]', 'Of the run'],
        ['Coverage', 'Tracked share of its frames'],
        ['Seed', ''],
        ['', ''],
      ],
      explanation.flights.map((flight) => reflightRow(context, explanation, flight)),
    ),
    h('section', {}, h('h4', {}, 'Time line of the flights', pageLink(context, name))),
    ...(untried.length === 0
      ? []
      : [h('section', {}, h('h4', {}, 'Not tried'), h('ul', { class: 'study-list' }, ...untried))]),
  ];
}

/** What the command writes, as a page of its own: to print, to keep, to send. */
function pageLink(context: Context, name: string): HTMLElement {
  const address = context.studies.pageAddress(name);
  return h('a', { href: address, target: '_blank', rel: 'noopener' }, 'Open as a page');
}

function verdictCell(verdict: 'yes' | 'no' | ''): HTMLElement {
  return h('td', { class: verdict === 'yes' ? 'bad' : '' }, verdict === '' ? kNothing : verdict);
}

function reflightRow(context: Context, explanation: Explanation, flight: Reflight): HTMLElement {
  const { name, survived, error, run, from_s, to_s, coverage, seed } = flight;
  return h(
    'tr',
    { 'data-flight': name },
    h('th', { scope: 'row' }, name),
    h(
      'td',
      { class: survived === true ? 'good' : error === null ? 'bad' : '' },
      reflightText(flight),
    ),
    h('td', { class: 'study-bands' }, bands(explanation, flight)),
    h('td', {}, `${formatNumber(from_s, 0)} to ${formatNumber(to_s, 1)}`),
    h('td', {}, formatPercent(coverage)),
    h('td', {}, String(seed)),
    h('td', {}, error === null ? openButton(context, run) : null),
  );
}

function bands(explanation: Explanation, flight: Reflight): HTMLElement {
  const [begin_s, end_s] = spanOf(explanation);
  const found = bandsOf(flight);
  const bar = h('span', { class: 'study-bar', role: 'img', 'aria-label': reflightText(flight) });
  if (found === null) return bar;
  const place = (time_s: number) => (100 * (time_s - begin_s)) / Math.max(1e-9, end_s - begin_s);
  const piece = (state: string, from_s: number, to_s: number) =>
    to_s <= from_s
      ? null
      : h('i', {
          'data-state': state,
          style: `left:${place(from_s).toFixed(2)}%;width:${(place(to_s) - place(from_s)).toFixed(2)}%`,
          title: `${state}: ${formatNumber(from_s, 1)} to ${formatNumber(to_s, 1)} s`,
        });
  for (const part of [
    piece('initialising', flight.from_s, found.initialised_s),
    piece('tracking', found.initialised_s, found.lost_s),
    piece('lost', found.lost_s, flight.to_s),
  ]) {
    if (part !== null) bar.append(part);
  }
  return bar;
}

// ---- prediction --------------------------------------------------------------------------------

function predictionParts(context: Context, name: string, prediction: Prediction): HTMLElement[] {
  const address = context.studies.pageAddress(name);
  const rows = prediction.stretches.map(({ from_s, to_s, risk_10_s, reasons }) =>
    h(
      'tr',
      {},
      h('th', { scope: 'row' }, `${formatNumber(from_s, 1)} to ${formatNumber(to_s, 1)} s`),
      h('td', { class: 'bad' }, formatPercent(risk_10_s, 0)),
      h('td', { class: 'study-reasons' }, reasons.join(', ')),
    ),
  );
  return [
    sentences(prediction.sentences),
    ...(rows.length === 0
      ? []
      : [
          table(
            'Risky parts',
            'study-stretches',
            [
              ['Time of the flight', ''],
              ['Highest risk', 'Of a loss within 10 s of such conditions'],
              ['Reasons', 'What adds most to the risk'],
            ],
            rows,
          ),
        ]),
    ...(prediction.warnings.length === 0
      ? []
      : [
          h(
            'section',
            {},
            h('h4', {}, 'Warnings'),
            h(
              'ul',
              { class: 'study-list' },
              ...prediction.warnings.map((text) => h('li', {}, text)),
            ),
          ),
        ]),
    h(
      'section',
      { class: 'study-report' },
      h('h4', {}, 'Time line, map and features', pageLink(context, name)),
      // Without scripts, forms and an origin of its own; the server's answer says so too.
      h('iframe', {
        src: `${address}#time-line`,
        sandbox: '',
        title: 'Time line of risk, map and features',
        'data-role': 'study-page',
      }),
    ),
  ];
}

// ---- hunt --------------------------------------------------------------------------------------

function huntParts(context: Context, name: string, result: HuntResult): HTMLElement[] {
  const worst = result.worst === null ? undefined : result.flights[result.worst];
  const rows = result.flights.map((flight, i) =>
    huntRow(context, result, flight, i, flight === worst),
  );
  return [
    sentences([huntSentence(result)]),
    ...(worst === undefined ? [] : [worstCard(context, name, result, worst)]),
    ...(rows.length === 0
      ? []
      : [
          table(
            'Flights in the order of the search',
            'study-hunted',
            [
              ['#', ''],
              ...result.axes.map(({ label, unit }) => [withUnit(label, unit), ''] as const),
              ['Margin', 'In [-1, 1]: negative where the flight failed'],
              ['Severity', 'How near to a failure, or how much of the flight was not survived'],
              ['Result', ''],
              ['', ''],
            ],
            rows,
          ),
        ]),
  ];
}

function worstCard(
  context: Context,
  name: string,
  { axes }: HuntResult,
  worst: HuntedFlight,
): HTMLElement {
  const save = async () => {
    const scenario = await context.studies.worst(name);
    if (scenario === null) return;
    const text = `${JSON.stringify(scenario, null, 2)}\n`;
    download(`${name}.worst.json`, new Blob([text], { type: 'application/json' }));
  };
  const values = axes.map(
    (axis) => `${axis.label} ${withUnit(valueText(worst.values[axis.name]), axis.unit, ' ')}`,
  );
  return h(
    'section',
    { class: 'study-worst', 'data-role': 'study-worst' },
    h(
      'div',
      {},
      h('b', {}, 'Worst flight: '),
      h('span', { class: worst.failed ? 'bad' : 'good' }, huntedText(worst)),
      h('p', {}, `${values.join(', ')}, seed ${worst.seed}`),
    ),
    h(
      'div',
      { class: 'sweep-buttons' },
      h(
        'button',
        {
          class: 'primary',
          'data-role': 'open-worst',
          onclick: () => context.studies.openRun(worst.run),
        },
        'Open',
      ),
      h(
        'button',
        {
          class: 'secondary',
          'data-role': 'download-worst',
          title: 'The flight as a scenario file, complete by itself',
          onclick: () => void save(),
        },
        'Download scenario',
      ),
    ),
  );
}

function huntRow(
  context: Context,
  { axes }: HuntResult,
  flight: HuntedFlight,
  index: number,
  worst: boolean,
): HTMLElement {
  const factors = Object.entries(flight.factors)
    .map(([factor, value]) => `${factor} ${formatNumber(value, 2)}`)
    .join(', ');
  const percent = Math.round(100 * severityOf(flight));
  return h(
    'tr',
    { 'data-failed': flight.failed ? 'true' : 'false', 'aria-current': worst ? 'true' : undefined },
    h('th', { scope: 'row' }, String(index + 1)),
    ...axes.map(({ name }) => h('td', {}, valueText(flight.values[name]))),
    h('td', { title: factors }, formatNumber(flight.margin, 3)),
    h(
      'td',
      { class: 'study-bands' },
      h(
        'span',
        { class: 'study-bar', role: 'img', 'aria-label': `severity ${percent} %` },
        h('i', {
          'data-state': flight.failed ? 'lost' : 'margin',
          style: `left:0;width:${percent}%`,
        }),
      ),
    ),
    h('td', { class: flight.failed ? 'bad' : 'good' }, flight.failed ? flight.failure : 'survives'),
    h('td', {}, openButton(context, flight.run)),
  );
}

// ---- parts -------------------------------------------------------------------------------------

function sentences(texts: readonly string[]): HTMLElement {
  return h(
    'section',
    { class: 'study-sentences', 'data-role': 'study-sentences' },
    ...texts.map((text, i) => h('p', { class: i === 0 ? 'verdict' : '' }, text)),
  );
}

/** @param heads  text and hint of each column */
function table(
  caption: string,
  role: string,
  heads: readonly (readonly [string, string])[],
  rows: readonly HTMLElement[],
): HTMLElement {
  return h(
    'section',
    {},
    h('h4', {}, caption),
    h(
      'div',
      { class: 'study-wide' },
      h(
        'table',
        { class: 'errors study-table', 'data-role': role, 'aria-label': caption },
        h(
          'thead',
          {},
          h('tr', {}, ...heads.map(([text, hint]) => h('th', { scope: 'col', title: hint }, text))),
        ),
        h('tbody', {}, ...rows),
      ),
    ),
  );
}

function openButton(context: Context, run: string): HTMLElement {
  return h(
    'button',
    { class: 'tab', 'data-run': run, onclick: () => context.studies.openRun(run) },
    'Open',
  );
}

function valueText(value: Json | undefined): string {
  if (typeof value === 'number') return String(Number(value.toPrecision(5)));
  return typeof value === 'string' ? value : JSON.stringify(value ?? null);
}

function withUnit(text: string, unit: string, between = ''): string {
  if (unit === '') return text;
  return between === '' ? `${text} [${unit}]` : `${text}${between}${unit}`;
}
