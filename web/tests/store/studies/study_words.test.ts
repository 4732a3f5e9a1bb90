import { describe, expect, it } from 'vitest';
import {
  bandsOf,
  causeRows,
  huntedText,
  huntSentence,
  progressTexts,
  reflightText,
  severityOf,
  spanOf,
  studyDetail,
} from '../../../src/store/studies/study_words';
import { explanation, hunted, reflight, studyEntry } from '../../support/studies';

describe('study words', () => {
  it('states progress and time left, or the place in the queue', () => {
    const progress = { share: 0.25, text: '3 of at most 12 flights', spent_s: 30, left_s: 90 };
    const made = studyEntry('a', 'running', { progress });
    expect(studyDetail(made)).toBe('Explanation · 25 % · 1 min 30 s left');
    expect(progressTexts(made)).toEqual([
      '3 of at most 12 flights',
      'at most 1 min 30 s left',
      '30 s so far',
    ]);
    const second = studyEntry('a', 'waiting', { position: 2, kind: 'hunt' });
    expect(studyDetail(second)).toBe('Hunt · 1 before it');
    expect(progressTexts(second)[0]).toBe('waits for 1 others');
  });

  it('says of each cause what is known about it', () => {
    const without = (cause: string, survived: boolean) =>
      reflight({ survived, changes: [{ cause, share: 0 }] });
    const found = explanation({
      necessary: ['blur'],
      margin: { cause: 'blur', survives_share: 0.125, fails_share: 0.25 },
      flights: [without('blur', true), without('noise', false)],
    });
    expect(causeRows(found)).toEqual([
      {
        words: 'Blur of the images',
        necessary: 'yes',
        sufficient: '',
        margin: 'survives 12.5 % of it, fails at 25 %',
      },
      { words: 'Noise of the sensor', necessary: 'no', sufficient: '', margin: '' },
    ]);
    const alone = explanation({ sufficient: ['noise'] });
    expect(causeRows(alone)[0]).toMatchObject({ necessary: '', sufficient: 'yes' });
    const broken = reflight({
      survived: null,
      error: 'exit 1',
      changes: [{ cause: 'b', share: 0 }],
    });
    const unknown = reflight({ survived: null, changes: [{ cause: 'c', share: 0 }] });
    expect(causeRows(explanation({ flights: [broken, unknown] }))).toMatchObject([
      { words: 'C', necessary: '', sufficient: '' },
    ]);
  });

  it('calls a cause insufficient only where it was tested by itself', () => {
    const found = explanation({ necessary: ['blur', 'noise'], sufficient: ['noise'] });
    const sufficient = (one: typeof found) => causeRows(one).map((row) => row.sufficient);
    expect(sufficient(found)).toEqual(['', 'yes']);
    expect(sufficient({ ...found, sufficiency_tested: ['blur', 'noise'] })).toEqual(['no', 'yes']);
  });

  it('has a row of each cause that was tested, in the order of the server', () => {
    const without = (cause: string) => reflight({ survived: true, changes: [{ cause, share: 0 }] });
    const found = explanation({
      necessary: ['n'],
      sufficient: ['s'],
      together: ['t'],
      pair: ['p', 't'],
      sufficiency_tested: ['s', 'tested'],
      withdrawn: ['single'],
      flights: [without('n'), without('single')],
    });
    expect(
      causeRows(found).map((row) => [row.words, row.necessary, row.sufficient].join(' ').trim()),
    ).toEqual(['N yes', 'S  yes', 'T', 'P', 'Tested  no', 'Single no']);
  });

  it('draws a flight from its start to the failure', () => {
    expect(bandsOf(reflight())).toEqual({ initialised_s: 3, lost_s: 8 });
    expect(bandsOf(reflight({ survived: true }))).toEqual({ initialised_s: 3, lost_s: 12 });
    const never = reflight({ initialised_at_s: null, outcome_time_s: null });
    expect(bandsOf(never)).toEqual({ initialised_s: 12, lost_s: 12 });
    const late = reflight({ outcome: 'INIT_LATE', initialised_at_s: 5, outcome_time_s: 5 });
    expect(bandsOf(late)).toEqual({ initialised_s: 7, lost_s: 12 });
    expect(bandsOf(reflight({ error: 'exit code 1' }))).toBeNull();
    expect(spanOf(explanation({ flights: [reflight({ from_s: 0, to_s: 13 })] }))).toEqual([0, 13]);
    expect(reflightText(reflight())).toBe('fails: LOST 6.0 s after its start');
    expect(reflightText(reflight({ error: 'exit code 1' }))).toBe('no result: exit code 1');
  });

  it('orders severity by the margin', () => {
    expect(severityOf(hunted(1))).toBe(0);
    expect(severityOf(hunted(-1))).toBe(1);
    expect(severityOf(hunted(-0.2))).toBeGreaterThan(severityOf(hunted(0.2)));
    expect(huntedText(hunted(0.314))).toBe('survives, margin 0.314');
    expect(huntedText(hunted(-0.5))).toBe('fails: LOST at 3.2 s');
  });

  it('says what a hunt has found', () => {
    const result = {
      title: '',
      estimator: 'feature',
      method: 'model',
      seed: 1,
      most_flights: 40,
      axes: [],
      flights_to_failure: null,
      exhausted: false,
      cancelled: false,
      worst: null,
      flights: [],
    };
    expect(huntSentence(result)).toBe('No flight is over yet.');
    expect(huntSentence({ ...result, flights: [hunted(0.5), hunted(0.4)] })).toBe(
      'feature survives all 2 flights.',
    );
    const failed = { ...result, flights: [hunted(-0.5)], flights_to_failure: 1, exhausted: true };
    expect(huntSentence(failed)).toBe(
      'Flight 1 is the first one that feature fails. Every point of the axes was flown.',
    );
  });
});
