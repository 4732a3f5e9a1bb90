// State of the page on which missions are drawn.
import type { FieldError } from '../../protocol/field_errors';
import type { MissionLimits, MissionReport, World, WorldEntry } from '../../protocol/mission_types';
import type { JsonObject } from '../../protocol/rest_types';
import type { FlightSettings } from './mission_document';
import type { Mission } from './mission_item';

/** The mission that is edited, with the scenario that it becomes. */
export interface MissionDraft {
  title: string;
  /** Name of the saved scenario; null = not saved yet. */
  name: string | null;
  /** The scenario that gives cameras, estimators and the rest, and its document. */
  base: string;
  baseDocument: JsonObject;
  /** Name of the world. */
  world: string;
  flight: FlightSettings;
  mission: Mission;
}

export interface MissionPage {
  open: boolean;
  /** null until read. */
  worlds: WorldEntry[] | null;
  /** Why the worlds could not be listed the last time. */
  listError: string | null;
  /** The draft's world once it is open. */
  world: World | null;
  worldError: string | null;
  /** The built-in world has not been made yet. */
  worldMissing: boolean;
  /** Share of a world that is being made; null = none is. */
  making: number | null;
  draft: MissionDraft | null;
  /** Counts the missions that were opened: another number is another mission. */
  opened: number;
  selected: number | null;
  report: MissionReport | null;
  /** The report is that of an earlier draft. */
  outdated: boolean;
  errors: FieldError[];
  camera: string;
  limits: MissionLimits;
  overlapInterval_s: number;
  /** What an import could not use, and the like. */
  notes: string[];
  /** Text of the draft as it was saved last. */
  savedText: string | null;
  working: boolean;
  canUndo: boolean;
  canRedo: boolean;
  /** Distance along the mission under the mouse [m]; null = none. */
  cursor_m: number | null;
}

export const kUsualLimits: MissionLimits = {
  min_clearance_m: 50,
  max_bank_deg: 45,
  min_overlap: 0.6,
  min_texels_px: 0.5,
  max_motion_px: 60,
  min_imagery: 0.95,
  min_start_s: 10,
  min_start_baseline: 0.5,
};

export function initialMissionPage(): MissionPage {
  return {
    open: false,
    worlds: null,
    listError: null,
    world: null,
    worldError: null,
    worldMissing: false,
    making: null,
    draft: null,
    opened: 0,
    selected: null,
    report: null,
    outdated: false,
    errors: [],
    camera: '',
    limits: { ...kUsualLimits },
    overlapInterval_s: 1,
    notes: [],
    savedText: null,
    working: false,
    canUndo: false,
    canRedo: false,
    cursor_m: null,
  };
}
