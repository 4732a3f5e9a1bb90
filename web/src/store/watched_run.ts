// One of the runs shown together: what the server sent about it, and how it is shown.
import type { RunInstant, SceneLabel, SeriesInfo } from '../protocol/messages';
import type { CameraInfo, EstimatorStatus, Metrics, Run } from '../protocol/rest_types';
import { isActive } from '../protocol/rest_types';
import type { ColourScale } from './pictures/colour_scale';
import type { PictureRate } from './pictures/picture_rates';
import { PictureMeter } from './pictures/picture_rates';
import type { EstimateRows } from './run_data';
import { RunData } from './run_data';

/** Of a JPEG or a video. */
export type DecodedImage = ImageBitmap | VideoFrame;

/** A decoded picture and the instant it belongs to. */
export interface Picture {
  frame: number;
  t_ns: number;
  width_px: number;
  height_px: number;
  live: boolean;
  scale: ColourScale | null;
  /** Of a scene. */
  labels: readonly SceneLabel[];
  /** Of the image before it was reduced. */
  fullWidth_px: number;
  fullHeight_px: number;
  bitmap: DecodedImage;
}

/** Estimates under an alignment other than the recorded one. */
export interface AlignedEstimates {
  mode: string;
  /** Contains no entry for an estimator without this alignment. */
  estimates: Map<string, EstimateRows>;
}

/** How many runs the server sends at a time. */
export const kMostRuns = 16;

/** How far the server moves a run on the clock, in both directions: a day. */
export const kMostOffset_ns = 86_400e9;

export class WatchedRun {
  /** null until the list or the stream has sent it. */
  run: Run | null = null;
  /** It is no longer on the server; what has come of it is still shown. */
  deleted = false;
  readonly data = new RunData();
  metrics: Metrics | null = null;
  /** Status of its estimators, by name. */
  statuses: Record<string, EstimatorStatus> = {};
  /** What the server offers to be plotted. */
  series: SeriesInfo[] = [];
  /** At the clock's time; null until the server has sent it. */
  instant: RunInstant | null = null;
  /** Time of the clock at its beginning, as requested. */
  offset_ns = 0;
  aligned: AlignedEstimates | null = null;
  /** By a second alignment, drawn next to the first; null = none. */
  compared: AlignedEstimates | null = null;
  /** Empty until its manifest was read. */
  cameras: CameraInfo[] = [];
  /** The camera whose images each estimator gets. */
  estimatorCameras: ReadonlyMap<string, string> = new Map();
  /** The camera shown; null = the first. */
  camera: string | null = null;
  readonly pictures = new Map<string, Picture>();
  /** Why pictures cannot be drawn, by the stream's name, until they come. */
  readonly refusals = new Map<string, string>();
  /** For the streams whose rate a real-time flight limits, by name. */
  rates = new Map<string, PictureRate>();
  readonly meter = new PictureMeter();
  /** Tracks that the viewer has hidden: names of estimators, '' = the truth. */
  hidden: ReadonlySet<string> = new Set();

  constructor(readonly id: string) {}

  /** Rows of an estimate under the shown alignment. */
  shownEstimate(name: string): EstimateRows | undefined {
    return this.aligned === null ? this.data.estimates.get(name) : this.aligned.estimates.get(name);
  }

  /** Whether all rows have come of a flight that is over; of one that is flown, those so far. */
  get isRead(): boolean {
    const { run, instant, data, statuses } = this;
    if (run === null || instant === null) return false;
    // The server sends the frames, then the estimates, then the log.
    const answers = Object.entries(statuses).every(
      ([name, { answered }]) => (data.estimates.get(name)?.table.length ?? 0) >= answered,
    );
    return isActive(run) || (data.truth.length >= run.frames && answers);
  }

  /** Seconds of the clock at its beginning. */
  get offset_s(): number {
    return this.offset_ns / 1e9;
  }
}
