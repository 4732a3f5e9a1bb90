// State of the page that calibrates a camera.
import type {
  CalibrationSession,
  CalibrationSolution,
  CalibrationSources,
  SavedCalibration,
  ViewDetail,
} from '../../protocol/calibration_types';
import type { CalibrationForm } from './calibration_form';
import { initialForm } from './calibration_form';

export interface CalibrationPage {
  open: boolean;
  /** null until read. */
  sources: CalibrationSources | null;
  saved: SavedCalibration[] | null;
  /** Cameras of the chosen scenario; null until read. */
  cameras: string[] | null;
  listError: string | null;
  form: CalibrationForm;
  /** A request is on its way. */
  busy: boolean;
  error: string | null;
  /** Why the session cannot be followed; null again once it can. */
  pollError: string | null;
  session: CalibrationSession | null;
  solution: CalibrationSolution | null;
  /** Views without which an estimate was asked for; null = those that the session leaves out. */
  leftOut: ReadonlySet<number> | null;
  /** The view shown next to the newest image; null = the last one. */
  selected: number | null;
  detail: ViewDetail | null;
  /** Name proposed for the result. */
  name: string;
  /** Files that are still to be sent. */
  sending: { done: number; total: number } | null;
}

export function initialCalibrationPage(): CalibrationPage {
  return {
    open: false,
    sources: null,
    saved: null,
    cameras: null,
    listError: null,
    form: initialForm(),
    busy: false,
    error: null,
    pollError: null,
    session: null,
    solution: null,
    leftOut: null,
    selected: null,
    detail: null,
    name: 'camera',
    sending: null,
  };
}

/** Where a list has no longer what was chosen of it. */
export function chooseFirst({ sources, form }: CalibrationPage): void {
  const lists = {
    folder: sources?.folders,
    recording: sources?.recordings,
    camera: sources?.cameras,
  };
  for (const [kind, list] of Object.entries(lists)) {
    const names = form.names as Record<string, string>;
    if (!list?.some(({ name }) => name === names[kind])) names[kind] = list?.[0]?.name ?? '';
  }
}
