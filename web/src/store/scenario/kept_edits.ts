// Edits of scenarios, and of runs to be flown again, while the launcher shows others.
import type { JsonObject } from '../../protocol/rest_types';
import type { State } from '../state';
import { sameJson } from './draft';

interface Kept {
  /** What they change. */
  document: JsonObject;
  edits: Map<string, string>;
}

export class KeptEdits {
  private readonly kept = new Map<string, Kept>();

  /** Keeps the edits of what is shown, before it is left. */
  keep(state: State): void {
    const { scenarioDocument: document, scenarioEdits: edits } = state;
    const key = keyOf(state);
    if (key !== null && document !== null && edits.size > 0)
      this.kept.set(key, { document, edits });
  }

  /**
   * Shows the edits of what has been chosen again, once it is read.
   * @return false if they cannot be kept, because what they change is another now
   */
  restore(state: State): boolean {
    const key = keyOf(state);
    const kept = this.kept.get(key ?? '');
    if (key === null || kept === undefined) return true;
    this.kept.delete(key);
    if (!sameJson(kept.document, state.scenarioDocument ?? undefined)) return false;
    state.scenarioEdits = kept.edits;
    return true;
  }
}

/** No scenario's name contains a slash. */
function keyOf({ repeatedRun, scenarioName }: State): string | null {
  return repeatedRun === null ? scenarioName : `run/${repeatedRun.id}`;
}
