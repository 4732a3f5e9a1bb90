// Watched runs of which the list of runs knows more than the stream: another process flies them, and
// the server reads them only when it is asked.
import type { Run } from '../../protocol/rest_types';
import { isActive } from '../../protocol/rest_types';
import type { Session } from '../session';

/** So many lists that know more than the stream are no coincidence. */
const kSilentLists = 2;

interface Silence {
  /** The last that the stream said. */
  said: string;
  /** Lists since then. */
  lists: number;
}

export class SilentRuns {
  private before = new Map<string, Silence>();
  private now = new Map<string, Silence>();

  constructor(private readonly session: Session) {}

  /** Whether the last list knew more of some run than the stream had said. */
  get any(): boolean {
    return this.now.size > 0;
  }

  beginList(): void {
    this.before = this.now;
    this.now = new Map();
  }

  /** Reads the run on if the stream has long sent nothing. @param streamed  what it said last */
  take(listed: Run, streamed: Run): void {
    const over = !isActive(listed);
    if (!isActive(streamed) || (!over && listed.frames <= streamed.frames)) return;
    const said = JSON.stringify([streamed.status, streamed.frames, over]);
    const silence = this.before.get(listed.id);
    const lists = silence?.said === said ? silence.lists + 1 : 1;
    this.now.set(listed.id, { said, lists });
    // All of a long run is not sent twice because the connection is slow.
    if (over ? lists === kSilentLists : lists % kSilentLists === 0) {
      this.session.readAgain(listed.id, over);
    }
  }
}
