// What the scenario editor shows, except the scenario and its changes.
import { kGeneral } from './sections';

export interface ScenarioEditorState {
  open: boolean;
  section: string;
  /** The section is shown as JSON in place of its form. */
  asJson: boolean;
  /** What is known of the changed scenario; `browser`: the server did not answer. */
  check: 'none' | 'waiting' | 'done' | 'browser';
  saving: boolean;
  /** Why the scenario was not saved; '' = nothing is wrong. */
  saveError: string;
  /** The saved scenario that would be replaced, if the viewer agrees. */
  replaces: string | null;
}

export function initialScenarioEditor(): ScenarioEditorState {
  return {
    open: false,
    section: kGeneral,
    asJson: false,
    check: 'none',
    saving: false,
    saveError: '',
    replaces: null,
  };
}
