// Words and figures of studies for people.
import type {
  Explanation,
  HuntedFlight,
  HuntResult,
  Reflight,
  StudyEntry,
  StudyKind,
} from '../../protocol/study_types';
import { formatDate, formatDuration, formatNumber, formatPercent } from '../format';

export const kKindWords: Record<StudyKind, string> = {
  explain: 'Explanation',
  predict: 'Prediction',
  hunt: 'Hunt',
};

/** State, progress and time left, in one line. */
export function studyDetail(study: StudyEntry): string {
  const { state, progress, position, created_utc } = study;
  const parts: string[] = [kKindWords[study.kind]];
  if (state === 'running' && progress !== null) {
    parts.push(formatPercent(progress.share, 0));
    if (progress.left_s !== null) parts.push(`${formatDuration(progress.left_s)} left`);
  } else if (position !== null) {
    parts.push(position === 1 ? 'next' : `${position - 1} before it`);
  } else {
    parts.push(formatDate(created_utc));
  }
  return parts.join(' · ');
}

/** What the page says of a study that is made or has ended. */
export function progressTexts({ state, progress, position, ended_utc, created_utc }: StudyEntry) {
  const texts: string[] = [];
  if (position !== null) {
    texts.push(position === 1 ? 'waits, as the next one' : `waits for ${position - 1} others`);
  }
  if (progress !== null) {
    texts.push(progress.text);
    if (progress.left_s !== null) texts.push(`at most ${formatDuration(progress.left_s)} left`);
    texts.push(`${formatDuration(progress.spent_s)} so far`);
  }
  if (ended_utc !== null) texts.push(`ended ${formatDate(ended_utc)}`);
  else if (state !== 'running') texts.push(`started ${formatDate(created_utc)}`);
  return texts;
}

export interface CauseRow {
  words: string;
  /** '' = not tried. */
  necessary: 'yes' | 'no' | '';
  sufficient: 'yes' | 'no' | '';
  margin: string;
}

/**
 * Each cause that a flight says something about, the named ones first: as findings_of() of the server
 * (cause_finding.cpp).
 */
export function causeRows(explanation: Explanation): CauseRow[] {
  const { necessary, sufficient, together, pair, margin, words, flights } = explanation;
  const tested = explanation.sufficiency_tested ?? [];
  const changed = flights.filter(({ changes, error }) => error === null && changes.length === 1);
  const named = [...necessary, ...sufficient, ...together, ...pair, ...tested];
  const causes = [...new Set([...named, ...changed.flatMap(causesOf)])];
  const failed = changed.filter(({ survived }) => survived === false).flatMap(causesOf);
  const unnecessary = [...failed, ...(explanation.withdrawn ?? [])];
  return causes.map((cause) => ({
    words: plainWords(words[cause] ?? cause),
    necessary: necessary.includes(cause) ? 'yes' : unnecessary.includes(cause) ? 'no' : '',
    sufficient: sufficient.includes(cause) ? 'yes' : tested.includes(cause) ? 'no' : '',
    margin: margin?.cause === cause ? marginText(margin) : '',
  }));
}

function causesOf({ changes }: Reflight): string[] {
  return changes.map(({ cause }) => cause);
}

/** "the blur of the images" -> "Blur of the images" */
export function plainWords(words: string): string {
  const bare = words.replace(/^the /, '');
  return bare.charAt(0).toUpperCase() + bare.slice(1);
}

/** "survives 12.5 % of it, fails at 25 %" */
export function marginText({ survives_share, fails_share }: NonNullable<Explanation['margin']>) {
  return `survives ${share(survives_share)} of it, fails at ${share(fails_share)}`;
}

/** "survives", "fails: LOST 3.2 s after its start" */
export function reflightText({ error, survived, outcome, outcome_time_s }: Reflight): string {
  if (error !== null) return `no result: ${error}`;
  if (survived === true) return 'survives';
  const after =
    outcome_time_s === null ? '' : ` ${formatNumber(outcome_time_s, 1)} s after its start`;
  return `fails: ${outcome ?? ''}${after}`;
}

/** Where an estimator initialised, tracked and was lost, by the time of the run [s]. */
export interface ReflightBands {
  initialised_s: number;
  lost_s: number;
}

export function bandsOf(flight: Reflight): ReflightBands | null {
  const { error, from_s, to_s, initialised_at_s, survived, outcome, outcome_time_s } = flight;
  if (error !== null) return null;
  const initialised_s = Math.min(to_s, from_s + (initialised_at_s ?? to_s - from_s));
  // One that initialises late tracks from then on.
  const failed = survived === false && outcome !== 'INIT_LATE';
  const lost = failed && initialised_at_s !== null && outcome_time_s !== null;
  const lost_s = lost ? Math.min(to_s, Math.max(initialised_s, from_s + outcome_time_s)) : to_s;
  return { initialised_s, lost_s };
}

/** The times that all flights of an explanation lie in [s]. */
export function spanOf({ from_s, to_s, flights }: Explanation): [number, number] {
  return [
    Math.min(from_s, ...flights.map((flight) => flight.from_s)),
    Math.max(to_s, ...flights.map((flight) => flight.to_s)),
  ];
}

/** The answer of a hunt. */
export function huntSentence({ estimator, flights, flights_to_failure, exhausted }: HuntResult) {
  if (flights.length === 0) return 'No flight is over yet.';
  const all = flights.length === 1 ? 'the one flight' : `all ${flights.length} flights`;
  const found =
    flights_to_failure === null
      ? `${estimator} survives ${all}.`
      : `Flight ${flights_to_failure} is the first one that ${estimator} fails.`;
  return exhausted ? `${found} Every point of the axes was flown.` : found;
}

/** "fails: LOST at 3.2 s", "survives, margin 0.31" */
export function huntedText({ failed, failure, margin }: HuntedFlight): string {
  return failed ? `fails: ${failure}` : `survives, margin ${formatNumber(margin, 3)}`;
}

/** From 0, far from a failure, to 1, never survived. */
export function severityOf({ margin }: HuntedFlight): number {
  return Math.min(1, Math.max(0, (1 - margin) / 2));
}

function share(value: number): string {
  return `${Number((100 * value).toFixed(1))} %`;
}
