// Prepares a study of the launcher's scenario with its changes.
import type { Context } from '../view';

/** Shows the errors of the scenario in its place if it has any. */
export function prepareStudy(
  { catalogue, layouts, notices, store, studies }: Context,
  kind: 'predict' | 'hunt',
): void {
  const source = catalogue.asked();
  if (source !== null) {
    void studies.prepare(kind, source);
    return;
  }
  studies.close();
  layouts.show('launcher');
  notices.error(
    store.state.scenarioDocument === null
      ? 'A study needs a scenario: choose one in Launch.'
      : 'No study can be made of this scenario: Launch shows why.',
  );
}
