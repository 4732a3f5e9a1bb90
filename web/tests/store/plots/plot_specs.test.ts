import { describe, expect, it } from 'vitest';
import { plotSpecs } from '../../../src/store/plots/plot_specs';
import { longestPause_s } from '../../../src/store/plots/sensor_figures';
import { runLetter, tracksOf } from '../../../src/store/tracks';
import { Viewing } from '../../support/viewing';
import { playbackMessage, sampleRun } from '../../support/samples';

const kSeries = [
  { stream: 'truth', column: 'x_m', label: 'x (east)', unit: 'm', group: 'x' },
  {
    stream: 'truth',
    column: 'exposure_ns',
    label: 'exposure',
    unit: 'ms',
    group: 'e',
    scale: 1e-6,
  },
  { stream: 'estimate/feature', column: 'error_m', label: 'position error', unit: 'm', group: 'p' },
  { stream: 'estimate/feature', column: 'error_up_m', label: 'error up', unit: 'm', group: 'q' },
  { stream: 'estimate/feature', column: 'counter.inliers', label: 'inliers', unit: '', group: 'c' },
  { stream: 'estimate/feature', column: 'latency_ms', label: 'latency', unit: 'ms', group: 'l' },
];

function twoRuns(): Viewing {
  const viewing = new Viewing();
  viewing.watch();
  viewing.session.addRun('r2', 5e9);
  viewing.socket.receive({ type: 'run', run: sampleRun({ id: 'r2', estimators: ['feature'] }) });
  for (const run of ['r1', 'r2']) {
    viewing.socket.receive({ type: 'series', run, series: kSeries });
    viewing.socket.receive({
      type: 'rows',
      run,
      stream: 'estimate/feature',
      seq: 0,
      columns: { frame: [0, 1], t_ns: [0, 1e9], error_m: [0.5, 1.5], 'counter.inliers': [9, null] },
    });
  }
  return viewing;
}

describe('tracksOf', () => {
  it('gives every estimate its own colour, and runs a letter when there are several', () => {
    const { state } = twoRuns().store;
    const tracks = tracksOf(state);
    expect(tracks.map(({ label, colour }) => [label, colour])).toEqual([
      ['A truth', 0],
      ['A feature', 0],
      ['B truth', 1],
      ['B feature', 1],
    ]);
    const alone = new Viewing();
    alone.watch();
    expect(tracksOf(alone.store.state).map(({ label }) => label)).toEqual(['truth', 'feature']);
    const [run] = alone.store.state.watched;
    if (run === undefined) throw new Error('no run');
    expect(runLetter(alone.store.state, run)).toBe('');
  });
});

describe('plotSpecs', () => {
  it('shows the poses of all tracks that are not hidden', () => {
    const { store, session } = twoRuns();
    session.showTrack('r1', '', false);
    const [x] = plotSpecs(store.state, 'pose');
    expect(x?.curves.map(({ name }) => name)).toEqual(['A feature', 'B truth', 'B feature']);
  });

  it('makes one plot of each column that has arrived, for all runs', () => {
    const { state } = twoRuns().store;
    const errors = plotSpecs(state, 'errors');
    expect(errors.map(({ key, unit, label }) => [key, unit, label])).toEqual([
      ['error_m', 'm', 'Position error'],
    ]);
    expect(errors[0]?.curves.map(({ name }) => name)).toEqual(['A feature', 'B feature']);
    expect(plotSpecs(state, 'estimates').map(({ label }) => label)).toEqual([
      'Inliers',
      'Missed frames',
    ]);
    expect(plotSpecs(state, 'image')).toEqual([]);
  });

  it('places a run at its offset on the clock', () => {
    const { state } = twoRuns().store;
    const curve = plotSpecs(state, 'errors')[0]?.curves[1]?.curve();
    expect(curve).toMatchObject({ t_offset_s: 5, t_scale_s: 1e-9, scale: 1 });
    expect([...(curve?.values as Float64Array)]).toEqual([0.5, 1.5]);
  });

  it('has the states of the shown estimates where they matter', () => {
    const { store, session } = twoRuns();
    session.showTrack('r1', 'feature', false);
    for (const group of ['pose', 'errors', 'estimates'] as const) {
      const lanes = plotSpecs(store.state, group)[0]?.lanes ?? [];
      expect(lanes.map(({ name, offset_s }) => [name, offset_s()])).toEqual([['B feature', 5]]);
      session.setOffset('r2', 7e9);
      expect(lanes[0]?.offset_s(), 'the run was moved').toBe(7);
      session.setOffset('r2', 5e9);
      expect(lanes[0]?.spans()).toHaveLength(1);
    }
  });

  it('counts the frames that an estimator has missed', () => {
    const missed = plotSpecs(twoRuns().store.state, 'estimates').at(-1);
    const curve = missed?.curves[0]?.curve();
    expect(curve?.values.length).toBe(63);
    expect(curve?.values[1]).toBe(0);
    expect(curve?.values[62]).toBe(61);
    expect(missed?.curves[1]?.curve()).toBeNull();
  });

  it('shows a count of frames from its first one on, from 0', () => {
    const viewing = twoRuns();
    const series = {
      column: 'dropped_frames',
      label: 'dropped frames',
      unit: 'frames',
      group: 'd',
    };
    const dropped = (run: string, counts: number[]) => {
      viewing.socket.receive({
        type: 'series',
        run,
        series: [{ stream: 'estimate/feature', ...series }],
      });
      const columns = { frame: [0, 1], t_ns: [0, 1e9], dropped_frames: counts };
      viewing.socket.receive({ type: 'rows', run, stream: 'estimate/feature', seq: 0, columns });
      const { state } = viewing.store;
      return plotSpecs(state, 'estimates').find(({ key }) => key === 'dropped_frames');
    };
    expect(dropped('r1', [0, 0])).toBeUndefined();
    const plot = dropped('r2', [0, 3]);
    expect(plot?.label).toBe('Dropped frames');
    expect(plot?.curves.map(({ curve }) => Array.from(curve()?.values ?? []))).toEqual([
      [0, 0],
      [0, 3],
    ]);
  });

  it('reads poses at the clock as the server sends them', () => {
    const viewing = twoRuns();
    const pose = { x_m: 3, y_m: 0, z_m: 0, roll_deg: 0, pitch_deg: 0, yaw_deg: -82 };
    viewing.socket.receive(playbackMessage({ truth: pose }));
    const specs = plotSpecs(viewing.store.state, 'pose');
    expect(specs[0]?.curves[0]?.atClock?.()).toBe(3);
    expect(specs[5]?.curves[0]?.atClock?.()).toBe(-82);
    expect(specs[0]?.curves[1]?.atClock?.()).toBeUndefined();
  });

  it('shows the sensors of the main run only', () => {
    const { store, session } = twoRuns();
    const curves = [{ name: 'pressure_pa', t_s: [0, 1], values: [100000, 100100] }];
    const sensors = [{ sensor: 'barometer', samples: 2, curves }];
    store.state.sensors = { run: 'r1', sensors, newest_s: 1, generation: 1 };
    const [pressure] = plotSpecs(store.state, 'sensors');
    expect(pressure?.curves[0]?.curve()).toMatchObject({ scale: 0.01, values: [100000, 100100] });
    session.makeMain('r2');
    expect(plotSpecs(store.state, 'sensors')).toEqual([]);
  });
});

describe('longestPause_s', () => {
  it('is several times the usual distance', () => {
    const t_s = Array.from({ length: 50 }, (_, i) => i * 0.2);
    expect(longestPause_s([...t_s, 30])).toBeCloseTo(1);
    expect(longestPause_s([])).toBe(Infinity);
  });
});
