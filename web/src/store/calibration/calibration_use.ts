// Takes a saved calibration into the launcher's scenario.
import type { Notices } from '../notices';
import { draftOf } from '../scenario/draft';
import type { State } from '../state';
import { calibratedSection } from './calibration_results';

/** Takes a section of the launcher's scenario as JSON, and has it checked. */
export interface SectionTaker {
  setText(section: string, text: string): void;
}

/** The scenario, with its changes, uses the calibration in its next flight. */
export function useInScenario(
  { scenarioDocument, scenarioEdits, scenarioName }: State,
  sections: SectionTaker,
  notices: Notices,
  calibration: { file: string; name: string },
): void {
  if (scenarioDocument === null) {
    notices.error('Choose a scenario in the launcher first.');
    return;
  }
  const { document, errors } = draftOf(scenarioDocument, scenarioEdits);
  const faulty = errors.find(({ field }) => field === 'camera' || field === 'cameras');
  if (faulty !== undefined) {
    notices.error(`Correct the scenario first: ${faulty.field} ${faulty.message}`);
    return;
  }
  const { section, value } = calibratedSection(document, calibration.file);
  sections.setText(section, JSON.stringify(value, null, 2));
  notices.info(`The next flight of ${scenarioName ?? 'the scenario'} uses ${calibration.name}.`);
}
