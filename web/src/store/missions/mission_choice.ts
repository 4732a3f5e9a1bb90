// Chooses the mission that is drawn next. One that is not saved is replaced by the second choice only.
import type { Store } from '../state';
import type { MissionDesk } from './mission_desk';

/** Finding an entry of the list again takes longer than a second click. */
const kAsked_ms = 10_000;
const kQuestion = 'The mission is not saved: choose again to replace it.';

/** The choice of a new mission. */
export const kNewMission = '+';

export class MissionChoice {
  /** What was chosen and is to be chosen again. */
  private asked: string | null = null;
  private questions = 0;

  constructor(
    private readonly store: Store,
    private readonly desk: Pick<MissionDesk, 'isUnsaved' | 'startNew' | 'openScenario'>,
    private readonly later: (callback: () => void, delay_ms: number) => void,
  ) {}

  /** @param name  of the scenario, or kNewMission */
  async choose(name: string): Promise<void> {
    const confirmed = this.asked === name;
    this.forget();
    if (this.desk.isUnsaved && !confirmed) this.ask(name);
    else if (name === kNewMission) await this.desk.startNew();
    else await this.desk.openScenario(name);
  }

  private ask(name: string): void {
    this.asked = name;
    this.questions += 1;
    const { questions } = this;
    this.store.state.missionPage.notes = [kQuestion];
    this.store.change('missions');
    this.later(() => {
      if (this.questions === questions) this.forget();
    }, kAsked_ms);
  }

  private forget(): void {
    const { missionPage } = this.store.state;
    this.asked = null;
    if (missionPage.notes[0] !== kQuestion) return;
    missionPage.notes = [];
    this.store.change('missions');
  }
}
