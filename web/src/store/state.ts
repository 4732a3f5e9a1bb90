// The whole state of the screen in one place, and notification of its changes.
import type { ConnectionState } from '../connection/stream_client';
import type { Access } from '../protocol/messages';
import type { FieldError } from '../protocol/field_errors';
import type { PixelAnswer, PixelQuestion } from '../protocol/pixel_types';
import type {
  CameraInfo,
  EstimatorStatus,
  JsonObject,
  Metrics,
  Run,
  ScenarioEntry,
} from '../protocol/rest_types';
import type { CalibrationPage } from './calibration/calibration_page';
import { initialCalibrationPage } from './calibration/calibration_page';
import { kDefaultAlignment } from './errors/error_table';
import type { LogPage } from './logs/log_browser';
import { initialLogPage } from './logs/log_browser';
import type { MissionPage } from './missions/mission_page';
import { initialMissionPage } from './missions/mission_page';
import type { PictureRate } from './pictures/picture_rates';
import type { Zoom } from './pictures/picture_zoom';
import type { Hover } from './pictures/pixel_probe';
import type { Clock, RunPlayback } from './playback/run_playback';
import type { ConnectState } from './vehicle/vehicle_connect';
import { initialConnect } from './vehicle/vehicle_connect';
import { RunData } from './run_data';
import type { ScenarioEditorState } from './scenario/scenario_editor';
import { initialScenarioEditor } from './scenario/scenario_editor';
import type { SceneLook } from './scene/scene_look';
import { usualLook } from './scene/scene_look';
import type { SweepPage } from './sweeps/sweep_page';
import { initialSweepPage } from './sweeps/sweep_page';
import type { StudyPage } from './studies/study_page';
import { initialStudyPage } from './studies/study_page';
import type { ScorePage } from './scoring/score_page';
import { initialScorePage } from './scoring/score_page';
import type { SensorSamples } from './sensors/sensors';
import type { PlotWindow } from './playback/time_window';
import type { TrackColour } from './track_colours';
import type { AlignedEstimates, Picture, WatchedRun } from './watched_run';

export interface Notice {
  id: number;
  level: 'info' | 'error';
  text: string;
}

const kNoRows = new RunData();
const kNoPictures: ReadonlyMap<string, Picture> = new Map();
const kNoRates: ReadonlyMap<string, PictureRate> = new Map();

export class State {
  connection: ConnectionState = { status: 'connecting', attempt: 1 };
  /** As the server said last, first by the page itself; it stays while the connection is lost. */
  access: Access = 'operator';
  /** null until read. */
  scenarios: ScenarioEntry[] | null = null;
  runs: Run[] | null = null;
  listError: string | null = null;
  scenarioName: string | null = null;
  scenarioDocument: JsonObject | null = null;
  /** The run whose scenario the launcher shows; null = that of `scenarioName`. */
  repeatedRun: Run | null = null;
  scenarioSchema: JsonObject | null = null;
  /** Changed sections of the scenario as JSON: text by section name; '' = removed. */
  scenarioEdits = new Map<string, string>();
  /** The server has another document now than the one that is edited. */
  scenarioChanged = false;
  scenarioEditor: ScenarioEditorState = initialScenarioEditor();
  /** What is known to be wrong with the changed scenario. */
  launchErrors: FieldError[] = [];
  launching = false;
  connect: ConnectState = initialConnect();
  /** The runs shown together, in the order in which they were added. */
  watched: WatchedRun[] = [];
  /** The one whose pictures, timeline and details are shown; always one of `watched`. */
  main: WatchedRun | null = null;
  clock: Clock | null = null;
  /** Requested and not confirmed yet. */
  wantedSpeed: number | null = null;
  /** Colours that the viewer gave to tracks (track_colours.ts). */
  colours: ReadonlyMap<string, TrackColour> = new Map();
  /** Chosen by the viewer; shown once a run is scored. */
  alignment: string = kDefaultAlignment;
  /** A second one to be compared with it; null = none. */
  compared: string | null = null;
  /** Of the main run; read while their plots are shown. */
  sensors: SensorSamples | null = null;
  /** Why the sensors' samples cannot be read. */
  sensorError: string | null = null;
  /** Pictures of all watched runs, not only of the main one. */
  sideBySide = true;
  /** Steps by which the server reduces pictures for this connection. */
  reduction = 0;
  /** What part of the pictures is shown, by group (pictures/picture_groups.ts). */
  zooms = new Map<string, Zoom>();
  /** Where the mouse points in a picture. */
  hover: Hover | null = null;
  /** What was asked about the pixel there, and the answer or why there is none. */
  pixel: { question: PixelQuestion; answer: PixelAnswer | string } | null = null;
  scene: SceneLook = usualLook();
  /** Group of plots that the panel of all of them shows; null = the first. */
  plotGroup: string | null = null;
  /** The part of the clock's time that plots show; null = all. */
  plotWindow: PlotWindow | null = null;
  /** The estimator whose debug images are shown; null = the first. */
  debugOf: string | null = null;
  /** The estimator whose view is compared; null = the camera's image itself. */
  imageErrorOf: string | null = null;
  notices: Notice[] = [];
  helpOpen = false;
  paletteOpen = false;
  logPage: LogPage = initialLogPage();
  scorePage: ScorePage = initialScorePage();
  calibrationPage: CalibrationPage = initialCalibrationPage();
  missionPage: MissionPage = initialMissionPage();
  sweepPage: SweepPage = initialSweepPage();
  studyPage: StudyPage = initialStudyPage();
  /** The pages in the order in which they were opened; some are closed again. */
  private opened: readonly { open: boolean }[] = [];

  /** Whether this browser may start and change something on the server. */
  get mayChange(): boolean {
    return this.access === 'operator';
  }

  /** The pages over the dashboard, which cover it while they are open. */
  get pages(): readonly { open: boolean }[] {
    return [
      this.scenarioEditor,
      this.logPage,
      this.scorePage,
      this.calibrationPage,
      this.missionPage,
      this.sweepPage,
      this.studyPage,
    ];
  }
  get covered(): boolean {
    return this.pages.some(({ open }) => open);
  }
  /** Opens a page over the others, also if it is open below them. */
  openPage(page: { open: boolean }): void {
    page.open = true;
    this.opened = [...this.opened.filter((other) => other !== page), page];
  }
  /** The page that was opened last. */
  get frontPage(): { open: boolean } | null {
    return this.opened.at(-1) ?? null;
  }
  /** The open page that lies over the others. */
  get topPage(): { open: boolean } | null {
    return this.opened.filter(({ open }) => open).at(-1) ?? null;
  }

  // ---- the main run ----------------------------------------------------------------------------

  get runId(): string | null {
    return this.main?.id ?? null;
  }
  get run(): Run | null {
    return this.main?.run ?? null;
  }
  get data(): RunData {
    return this.main?.data ?? kNoRows;
  }
  get metrics(): Metrics | null {
    return this.main?.metrics ?? null;
  }
  get statuses(): Record<string, EstimatorStatus> {
    return this.main?.statuses ?? {};
  }
  get aligned(): AlignedEstimates | null {
    return this.main?.aligned ?? null;
  }
  get cameras(): readonly CameraInfo[] {
    return this.main?.cameras ?? [];
  }
  get camera(): string | null {
    return this.main?.camera ?? null;
  }
  get pictures(): ReadonlyMap<string, Picture> {
    return this.main?.pictures ?? kNoPictures;
  }
  get rates(): ReadonlyMap<string, PictureRate> {
    return this.main?.rates ?? kNoRates;
  }
  /** Time of the clock at its beginning. */
  get offset_ns(): number {
    return this.main?.offset_ns ?? 0;
  }
  /** null until the server has sent where the run is. */
  get playback(): RunPlayback | null {
    const instant = this.main?.instant ?? null;
    if (instant === null || this.clock === null) return null;
    const { frame, alignment, truth, estimates } = instant;
    return { ...this.clock, frame, alignment, truth, estimates };
  }

  /** The run of this name if it is watched. */
  watchedRun(id: string): WatchedRun | undefined {
    return this.watched.find((watched) => watched.id === id);
  }
}

/**
 * When the flight ends by its own time, as far as that is known; 0 for a live vehicle, whose flight
 * has only a limit that may be a day away.
 */
export function plannedEnd_ns({ run, data }: Pick<WatchedRun, 'run' | 'data'>): number {
  return data.vehicle.length > 0 ? 0 : (run?.duration_ns ?? 0);
}

/** The part of the clock's time in which the watched runs lie [ns]. */
export function clockSpan_ns({ watched, clock }: State): [number, number] {
  let begin_ns = Math.min(0, clock?.begin_ns ?? 0);
  let end_ns = Math.max(1e9, clock?.end_ns ?? 0);
  for (const one of watched) {
    const last_ns = one.data.truth.length === 0 ? 0 : one.data.truth.last('t_ns');
    begin_ns = Math.min(begin_ns, one.offset_ns);
    end_ns = Math.max(end_ns, one.offset_ns + Math.max(plannedEnd_ns(one), last_ns));
  }
  return [begin_ns, end_ns];
}

/** The alignment in which estimates are drawn now. */
export function shownAlignment({ aligned }: Pick<WatchedRun, 'aligned'>): string {
  return aligned?.mode ?? kDefaultAlignment;
}

/** Views redraw themselves for the topics that changed since the last frame. */
const kTopicNames = [
  'connection',
  'lists',
  'launch',
  'run',
  'rows',
  'log',
  'metrics',
  'estimators',
  'playback',
  'plotTime',
  'pictures',
  'zoom',
  'hover',
  'scene',
  'plots',
  'cameras',
  'sensors',
  'notices',
  'help',
  'logs',
  'scoring',
  'calibration',
  'missions',
  'missionCursor',
  'sweeps',
  'studies',
  'layout',
  'theme',
  'palette',
] as const;
export type Topic = (typeof kTopicNames)[number];

/** Everything, for a view that is new or was hidden. */
export const kTopics: ReadonlySet<Topic> = new Set(kTopicNames);

/** When a change is to be seen. */
export type ShowAt = 'next_frame' | 'now';

export class Store {
  readonly state = new State();
  private changed = new Set<Topic>();
  private listener: ((when: ShowAt) => void) | null = null;

  constructor(access: Access = 'operator') {
    this.state.access = access;
  }

  /** Calls back once when something has changed since the last take(), and whenever it must be shown now. */
  onChange(listener: (when: ShowAt) => void): void {
    this.listener = listener;
    if (this.changed.size > 0) listener('next_frame');
  }

  change(...topics: Topic[]): void {
    const quiet = this.changed.size === 0;
    for (const topic of topics) this.changed.add(topic);
    if (quiet) this.listener?.('next_frame');
  }

  /** Shown at once: of keys that follow within the frame none is lost. */
  setPaletteOpen(open: boolean): void {
    this.state.paletteOpen = open;
    this.changed.add('palette');
    this.listener?.('now');
  }

  /** Everything may look different then. */
  setAccess(access: Access): void {
    if (this.state.access === access) return;
    this.state.access = access;
    this.change(...kTopicNames);
  }

  /** The topics changed since the last call. */
  take(): ReadonlySet<Topic> {
    const taken = this.changed;
    this.changed = new Set();
    return taken;
  }
}
