// What the plots over time show: groups of plots, made from the series that the server offers.
import type { SensorCurve } from '../../protocol/sensor_types';
import type { SeriesInfo } from '../../protocol/messages';
import { isActive } from '../../protocol/rest_types';
import { kTextureLimit } from '../errors/error_table';
import type { Axis } from '../run_data';
import { kAxes } from '../run_data';
import type { State } from '../state';
import type { StateSpan } from '../state_spans';
import { spansOf } from '../state_spans';
import type { Table } from '../table';
import type { TrackColour } from '../track_colours';
import type { Track } from '../tracks';
import { drawnTracks, shownTracks, tableOf } from '../tracks';
import type { WatchedRun } from '../watched_run';
import type { Curve } from './curve';
import { knownMissedFrames } from './missed_frames';
import { kSensorFigures, longestPause_s } from './sensor_figures';

export type PlotGroup = 'pose' | 'errors' | 'image' | 'estimates' | 'sensors' | 'vehicle';

/** Truth is red, an estimate has its own colour, other curves are neutral or of an axis. */
export type CurveHue =
  | { kind: 'truth'; order: number; chosen?: TrackColour }
  | { kind: 'estimate'; colour: number; chosen?: TrackColour; second?: true }
  | { kind: 'run'; order: number }
  | { kind: 'axis'; axis: number };

export interface CurveSpec {
  name: string;
  /** In front of its value: of curves of several runs the run's letter. */
  short: string;
  hue: CurveHue;
  /** As it is now; null if there are no rows yet. */
  curve: () => Curve | null;
  /** The exact value at the clock's time, where the server sends it. */
  atClock?: () => number | null | undefined;
}

export interface PlotSpec {
  key: string;
  label: string;
  hint?: string;
  unit: string;
  /** Digits of values. */
  digits: number;
  /** Minimum span of the axis, so that noise does not fill the plot. */
  least: number;
  /** Counts from 0 on; there is no plot before it has counted something. */
  counts?: true;
  /** An estimate that diverges reaches any value: the axis leaves it out. */
  unbounded?: boolean;
  /** Lower limit of good values, drawn as a dashed line. */
  limit?: number;
  curves: CurveSpec[];
  /** Below the curves. */
  lanes?: readonly StateLane[];
}

/** The states of an estimate over time. */
export interface StateLane {
  name: string;
  hue: CurveHue;
  /** As they are now, in times of the run. */
  spans: () => readonly StateSpan[];
  /** Seconds of the clock at the beginning of the run, as it is now. */
  offset_s: () => number;
}

export const kAxisLabels: Readonly<Record<Axis, string>> = {
  x_m: 'x east',
  y_m: 'y north',
  z_m: 'z up',
  roll_deg: 'Roll',
  pitch_deg: 'Pitch',
  yaw_deg: 'Yaw',
};

/** What is better known here than from the series' unit, by column. */
const kKnown: Readonly<Record<string, Partial<PlotSpec>>> = {
  texels_per_pixel: { label: 'Texture (median)', digits: 2, least: 0.5, limit: kTextureLimit },
  exposure_ns: { digits: 3, least: 0.5 },
  saturated_fraction: { digits: 1, least: 2 },
  void_fraction: { digits: 1, least: 2 },
  gain: { digits: 2, least: 0.5 },
  error_m: {
    unbounded: true,
    digits: 3,
    least: 0.1,
    hint: 'Distance between the estimated and the true position',
  },
  error_along_m: {
    unbounded: true,
    digits: 3,
    least: 0.1,
    hint: 'In the direction of the true motion',
  },
  error_across_m: {
    unbounded: true,
    digits: 3,
    least: 0.1,
    hint: 'To the right of the true motion',
  },
  error_up_m: {
    unbounded: true,
    digits: 3,
    least: 0.1,
    hint: 'Estimated height minus the true one',
  },
  error_rotation_deg: { digits: 3, least: 0.1, hint: 'Angle between the two attitudes' },
  error_scale_percent: {
    unbounded: true,
    digits: 3,
    least: 0.1,
    hint: 'Estimated distance over the last 100 m against the true one: drift of the scale',
  },
  error_relative_percent: {
    unbounded: true,
    digits: 3,
    least: 0.1,
    hint: 'Position error over the last 100 m of the path, in % of them',
  },
  error_relative_deg: {
    digits: 3,
    least: 0.1,
    hint: 'Rotation error over the last 100 m of the path',
  },
  latency_ms: { digits: 1, least: 5, hint: 'From the frame to its answer' },
  late_frames: {
    counts: true,
    digits: 0,
    least: 4,
    hint: 'Frames so far that the camera did not draw because the next one was due',
  },
  dropped_frames: {
    counts: true,
    digits: 0,
    least: 4,
    hint: 'Frames so far that arrived while the estimator was busy',
  },
  unanswered_frames: {
    counts: true,
    digits: 0,
    least: 4,
    hint: 'Frames so far that the estimator took and did not answer in time',
  },
};

export function plotSpecs(state: State, group: PlotGroup): PlotSpec[] {
  if (group === 'sensors') return sensorSpecs(state);
  const specs = group === 'pose' ? poseSpecs(state) : seriesSpecs(state, group);
  if (group === 'estimates') specs.push(...missedSpecs(state));
  const lanes = kOfEstimates.includes(group) ? stateLanes(state) : [];
  return specs.map((spec) => ({ ...spec, lanes }));
}

/** Groups whose values depend on the estimators' states. */
const kOfEstimates: readonly PlotGroup[] = ['pose', 'errors', 'estimates'];

function stateLanes(state: State): StateLane[] {
  return shownTracks(state)
    .filter(({ name }) => name !== '')
    .map((track) => ({
      name: track.label,
      hue: hueOf(track),
      spans: () => spansOf(track),
      offset_s: () => track.run.offset_s,
    }));
}

/** The group in which a series is shown; null if it is part of a pose. */
export function groupOf({ stream, column }: SeriesInfo): PlotGroup | null {
  if (kAxes.some((axis) => axis === column)) return null;
  if (stream === 'truth') return 'image';
  if (stream === 'vehicle') return 'vehicle';
  return column.startsWith('error_') ? 'errors' : 'estimates';
}

function poseSpecs(state: State): PlotSpec[] {
  const tracks = drawnTracks(state);
  return kAxes.map((axis) => {
    const angle = axis.endsWith('_deg');
    return {
      key: axis,
      label: kAxisLabels[axis],
      unit: angle ? 'deg' : 'm',
      digits: angle ? 2 : 1,
      least: angle ? 4 : 2,
      unbounded: !angle,
      curves: tracks.map((track) => ({
        name: track.label,
        short: track.letter,
        hue: hueOf(track),
        curve: () => curveOf(tableOf(track), track.run, axis, 1, angle),
        ...(track.by === undefined ? { atClock: () => poseAtClock(track)?.[axis] } : {}),
      })),
    };
  });
}

function poseAtClock({ run, name }: Track) {
  return name === '' ? run.instant?.truth : run.instant?.estimates[name]?.pose;
}

/** One plot for each column of the group of which values have arrived. */
function seriesSpecs(state: State, group: PlotGroup): PlotSpec[] {
  const specs = new Map<string, PlotSpec>();
  const counted = new Set<string>();
  for (const track of group === 'errors' ? drawnTracks(state) : shownTracks(state)) {
    for (const series of track.run.series) {
      if (groupOf(series) !== group || trackOf(series) !== track.name) continue;
      const table = seriesTable(track, series);
      if (table?.has(series.column) !== true) continue;
      const spec = specs.get(series.column) ?? specOf(series);
      specs.set(series.column, spec);
      if (table.last(series.column) > 0) counted.add(series.column);
      spec.curves.push({
        name: track.label,
        short: track.letter,
        hue: track.name === '' ? { kind: 'run', order: track.order } : hueOf(track),
        curve: () =>
          curveOf(seriesTable(track, series), track.run, series.column, series.scale ?? 1, false),
      });
    }
  }
  return [...specs.values()].filter(({ key, counts }) => counts !== true || counted.has(key));
}

function specOf({ column, label, unit }: SeriesInfo): PlotSpec {
  const spec = { key: column, label: capital(label), unit, digits: 1, least: 1, curves: [] };
  return { ...spec, ...kKnown[column] };
}

/** Frames without an answer, as far as they can be told. */
function missedSpecs(state: State): PlotSpec[] {
  const answering = shownTracks(state).filter(
    (track) => track.name !== '' && answersOf(track) !== undefined,
  );
  if (answering.length === 0) return [];
  const curves = answering.map((track) => ({
    name: track.label,
    short: track.letter,
    hue: hueOf(track),
    curve: () => missedCurve(track),
  }));
  const hint =
    'Frames without an answer so far: dropped while the estimator was busy, not answered in time, or never given';
  return [
    {
      key: 'missed_frames',
      label: 'Missed frames',
      hint,
      unit: 'frames',
      digits: 0,
      least: 4,
      curves,
    },
  ];
}

function answersOf({ run, name }: Track): Table | undefined {
  const table = run.data.estimates.get(name)?.table;
  return table === undefined || table.length === 0 ? undefined : table;
}

function missedCurve(track: Track): Curve | null {
  const { run } = track;
  const answers = answersOf(track);
  if (answers === undefined || run.data.truth.length === 0) return null;
  const over = run.run !== null && !isActive(run.run);
  const { t_ns, count } = knownMissedFrames(run.data.truth, answers, over, run.data.generation);
  return {
    ...curveTime(run),
    t: t_ns,
    values: count,
    scale: 1,
    longest_gap_s: Infinity,
    wraps: false,
  };
}

/** The estimator whose series it is; '' = a series of the flight. */
function trackOf({ stream }: SeriesInfo): string {
  return stream.startsWith('estimate/') ? stream.slice('estimate/'.length) : '';
}

function seriesTable(track: Track, { stream }: SeriesInfo): Table | undefined {
  return stream === 'vehicle' ? track.run.data.vehicleTable : tableOf(track);
}

export function hueOf({ name, order, colour, chosen, by }: Track): CurveHue {
  const second = by === undefined ? {} : { second: true as const };
  const own = { ...(chosen === null ? {} : { chosen }), ...second };
  return name === '' ? { kind: 'truth', order, ...own } : { kind: 'estimate', colour, ...own };
}

/** Frames that were dropped do not break a curve; lost ones have no value and do. */
function curveOf(
  table: Table | undefined,
  run: WatchedRun,
  column: string,
  scale: number,
  wraps: boolean,
): Curve | null {
  if (table === undefined || table.length === 0) return null;
  return {
    ...curveTime(run),
    t: table.column('t_ns'),
    values: table.column(column),
    scale,
    longest_gap_s: Infinity,
    wraps,
  };
}

/** Of stamps of a run. */
function curveTime({ offset_s }: WatchedRun) {
  return { t_scale_s: 1e-9, t_offset_s: offset_s };
}

/** Plots of the sensors that the main run has. */
function sensorSpecs(state: State): PlotSpec[] {
  return kSensorFigures.flatMap((figure) => {
    const { key, label, hint, unit, digits, least, names } = figure;
    const curvesNow = () => sensorCurves(state, figure.sensor, figure.curves);
    if (curvesNow().length === 0) return [];
    const curves = figure.curves.map(
      (_, i): CurveSpec => ({
        name: names?.[i] ?? '',
        short: names?.[i] ?? '',
        hue: figure.curves.length === 1 ? { kind: 'run', order: 0 } : { kind: 'axis', axis: i },
        curve: () => sensorCurve(state, curvesNow()[i], 1 / figure.per_unit),
      }),
    );
    return [{ key, label, hint, unit, digits, least, curves }];
  });
}

function sensorCurves(state: State, sensor: string, names: readonly string[]): SensorCurve[] {
  const { sensors, runId } = state;
  if (sensors === null || sensors.run !== runId) return [];
  const found = sensors.sensors.find((one) => one.sensor === sensor);
  return names.flatMap((name) => found?.curves.find((curve) => curve.name === name) ?? []);
}

function sensorCurve(state: State, curve: SensorCurve | undefined, scale: number): Curve | null {
  if (curve === undefined) return null;
  return {
    t: curve.t_s,
    t_scale_s: 1,
    t_offset_s: state.offset_ns / 1e9,
    values: curve.values,
    scale,
    longest_gap_s: longestPause_s(curve.t_s),
    wraps: false,
  };
}

function capital(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
