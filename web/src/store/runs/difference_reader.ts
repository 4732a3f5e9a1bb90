// Reads what differs between the runs that are shown together, while that is shown.
import { errorText } from '../../connection/rest_error';
import type { Differences } from '../../protocol/rest_types';

export type DifferenceRest = {
  differences: (runs: readonly string[], signal: AbortSignal) => Promise<Differences>;
};

/** null while it is read; a text says why it cannot be read. */
export type DifferenceAnswer = Differences | string | null;

export class DifferenceReader {
  answer: DifferenceAnswer = null;
  private key = '';
  private reading = new AbortController();

  constructor(
    private readonly rest: DifferenceRest,
    /** Called when `answer` has changed. */
    private readonly onChange: () => void,
  ) {}

  /**
   * What failed is read again by the next call; its reason stays until there is another answer.
   * @param key  changes when the same runs must be read again
   */
  show(runs: readonly string[], key: string): void {
    const whole = JSON.stringify([runs, key]);
    if (whole === this.key) return;
    this.reading.abort();
    this.key = whole;
    if (typeof this.answer !== 'string') this.answer = null;
    if (runs.length >= 2) void this.read(runs);
    else this.onChange();
  }

  /** Stops reading and forgets the answer. */
  hide(): void {
    this.reading.abort();
    this.key = '';
    this.answer = null;
  }

  private async read(runs: readonly string[]): Promise<void> {
    const reading = new AbortController();
    this.reading = reading;
    let answer: DifferenceAnswer;
    try {
      answer = await this.rest.differences(runs, reading.signal);
    } catch (error) {
      answer = errorText(error);
      if (!reading.signal.aborted) this.key = '';
    }
    if (reading.signal.aborted) return;
    this.answer = answer;
    this.onChange();
  }
}
