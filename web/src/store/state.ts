// The whole state of the screen in one place, and notification of its changes.
import type { ConnectionState } from '../connection/stream_client';
import { picturesOf } from '../connection/stream_client';
import type { FieldError } from '../protocol/field_errors';
import type { SceneMode, SceneView, SeriesInfo } from '../protocol/messages';
import type {
  CameraInfo,
  EstimatorStatus,
  JsonObject,
  Metrics,
  Run,
  ScenarioEntry,
} from '../protocol/rest_types';
import { kDefaultAlignment } from './error_table';
import type { LogPage } from './logs/log_browser';
import { initialLogPage } from './logs/log_browser';
import type { PictureRate } from './picture_rates';
import type { EstimateRows } from './run_data';
import type { RunPlayback } from './run_playback';
import type { ConnectState } from './vehicle/vehicle_connect';
import { initialConnect } from './vehicle/vehicle_connect';
import { RunData } from './run_data';
import type { SensorSamples } from './sensors/sensors';

/** A decoded picture and the instant it belongs to. */
export interface Picture {
  frame: number;
  t_ns: number;
  width_px: number;
  height_px: number;
  live: boolean;
  bitmap: ImageBitmap;
}

export interface Notice {
  id: number;
  level: 'info' | 'error';
  text: string;
}

export type SceneOrbit = Pick<SceneView, 'azimuth_deg' | 'elevation_deg' | 'distance_m' | 'follow'>;

/** Estimates under an alignment other than the recorded one. */
export interface AlignedEstimates {
  mode: string;
  /** Contains no entry for an estimator without this alignment. */
  estimates: Map<string, EstimateRows>;
}

export interface State {
  connection: ConnectionState;
  /** null until read. */
  scenarios: ScenarioEntry[] | null;
  runs: Run[] | null;
  listError: string | null;
  scenarioName: string | null;
  scenarioDocument: JsonObject | null;
  scenarioSchema: JsonObject | null;
  /** Sections of the scenario edited as JSON: text by section name. */
  scenarioEdits: Map<string, string>;
  editorOpen: boolean;
  launchErrors: FieldError[];
  launching: boolean;
  connect: ConnectState;
  /** The watched run; `run` is null until the list or the stream has sent it. */
  runId: string | null;
  run: Run | null;
  data: RunData;
  metrics: Metrics | null;
  /** Status of the run's estimators, by name. */
  statuses: Record<string, EstimatorStatus>;
  playback: RunPlayback | null;
  /** What the server offers of the run to be plotted. */
  series: SeriesInfo[];
  /** Requested and not confirmed yet. */
  wantedSpeed: number | null;
  pictures: Map<string, Picture>;
  /** For the streams whose rate is below the requested one, by name. */
  rates: Map<string, PictureRate>;
  /** Chosen by the viewer; shown once the run is scored. */
  alignment: string;
  aligned: AlignedEstimates | null;
  /** Of the watched run; empty until its manifest was read. */
  cameras: CameraInfo[];
  /** Read while their plots are shown. */
  sensors: SensorSamples | null;
  /** Why the sensors' samples cannot be read. */
  sensorError: string | null;
  /** null = the first. */
  camera: string | null;
  sceneMode: SceneMode;
  sceneOrbits: Record<SceneMode, SceneOrbit>;
  notices: Notice[];
  helpOpen: boolean;
  logPage: LogPage;
}

export function initialState(): State {
  return {
    connection: { status: 'connecting', attempt: 1 },
    scenarios: null,
    runs: null,
    listError: null,
    scenarioName: null,
    scenarioDocument: null,
    scenarioSchema: null,
    scenarioEdits: new Map(),
    editorOpen: false,
    launchErrors: [],
    launching: false,
    connect: initialConnect(),
    runId: null,
    run: null,
    data: new RunData(),
    metrics: null,
    statuses: {},
    playback: null,
    series: [],
    wantedSpeed: null,
    pictures: new Map(),
    rates: new Map(),
    alignment: kDefaultAlignment,
    aligned: null,
    cameras: [],
    sensors: null,
    sensorError: null,
    camera: null,
    sceneMode: 'chase',
    sceneOrbits: {
      chase: { azimuth_deg: 20, elevation_deg: 18, distance_m: 40, follow: true },
      orbit: { azimuth_deg: 215, elevation_deg: 35, distance_m: 900, follow: true },
      top: { azimuth_deg: 0, elevation_deg: 90, distance_m: 2400, follow: false },
    },
    notices: [],
    helpOpen: false,
    logPage: initialLogPage(),
  };
}

/**
 * When the flight ends as far as that is known; 0 for a live vehicle, whose flight has only a limit
 * that may be a day away.
 */
export function plannedEnd_ns({ run, data }: State): number {
  return data.vehicle.length > 0 ? 0 : (run?.duration_ns ?? 0);
}

/** The alignment in which estimates are drawn now. */
export function shownAlignment(state: State): string {
  return state.aligned?.mode ?? kDefaultAlignment;
}

/** Rows of an estimate under the shown alignment. */
export function shownEstimate(state: State, name: string): EstimateRows | undefined {
  return state.aligned === null
    ? state.data.estimates.get(name)
    : state.aligned.estimates.get(name);
}

/** The name under which the chosen camera's pictures arrive. */
export function cameraPictures(state: State): string {
  return picturesOf('camera', state.camera ?? undefined);
}

/** Views redraw themselves for the topics that changed since the last frame. */
export type Topic =
  | 'connection'
  | 'lists'
  | 'launch'
  | 'run'
  | 'rows'
  | 'log'
  | 'metrics'
  | 'estimators'
  | 'playback'
  | 'pictures'
  | 'scene'
  | 'cameras'
  | 'sensors'
  | 'notices'
  | 'help'
  | 'logs';

export class Store {
  readonly state = initialState();
  private changed = new Set<Topic>();
  private listener: (() => void) | null = null;

  /** Calls back once when something has changed since the last take(). */
  onChange(listener: () => void): void {
    this.listener = listener;
    if (this.changed.size > 0) listener();
  }

  change(...topics: Topic[]): void {
    const quiet = this.changed.size === 0;
    for (const topic of topics) this.changed.add(topic);
    if (quiet) this.listener?.();
  }

  /** The topics changed since the last call. */
  take(): ReadonlySet<Topic> {
    const taken = this.changed;
    this.changed = new Set();
    return taken;
  }
}
