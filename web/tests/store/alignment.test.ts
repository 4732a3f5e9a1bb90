import { beforeEach, describe, expect, it } from 'vitest';
import { RestClient } from '../../src/connection/rest_client';
import { Alignment, canBeDrawn } from '../../src/store/alignment';
import { Cameras } from '../../src/store/pictures/cameras';
import { Notices } from '../../src/store/notices';
import { plotSpecs } from '../../src/store/plots/plot_specs';
import { drawnTracks, scaleOf } from '../../src/store/tracks';
import { curveStyle } from '../../src/views/colours';
import { shownAlignment } from '../../src/store/state';
import { playbackMessage } from '../support/samples';
import { Viewing } from '../support/viewing';

const metrics = {
  estimators: {
    feature: {
      outcome: 'COMPLETED',
      alignments: { init_scale: { S_world_vo: {} }, sim3: { S_world_vo: {} }, se3: { scale: 1 } },
    },
  },
};

let viewing: Viewing;
let asked: string[];
let answer: () => Response;

function rest(): RestClient {
  return new RestClient('api', (url) => {
    asked.push(url);
    return Promise.resolve(answer());
  });
}

beforeEach(() => {
  viewing = new Viewing();
  asked = [];
  answer = () =>
    Response.json({ frame: [0, 1], t_ns: [0, 1], state: ['TRACKING', 'LOST'], x_m: [7, null] });
  viewing.watch();
});

describe('Alignment', () => {
  const alignment = () =>
    new Alignment(
      viewing.store,
      rest(),
      viewing.session,
      new Notices(viewing.store, () => undefined),
    );

  it('draws the estimates as the server places them, and has the views do so', async () => {
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    const chosen = alignment();
    await chosen.choose('sim3');
    expect(asked).toEqual(['api/runs/r1/trajectories/feature?format=json&alignment=sim3']);
    expect(viewing.socket.last()).toMatchObject({ type: 'align', mode: 'sim3' });
    expect(shownAlignment(viewing.store.state)).toBe('sim3');
    expect(viewing.store.state.main?.shownEstimate('feature')?.table.at('x_m', 0)).toBe(7);
    await chosen.choose('init_scale');
    expect(viewing.socket.last()).toMatchObject({ type: 'align', mode: 'init_scale' });
    expect(viewing.store.state.aligned).toBeNull();
  });

  it('draws estimates a second time, by the alignment they are compared with', async () => {
    const { state } = viewing.store;
    const values = () =>
      plotSpecs(state, 'pose')[0]?.curves.map(({ name, curve }) => [name, curve()?.values[0]]);
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    const chosen = alignment();
    await chosen.compare('sim3');
    expect(asked).toEqual(['api/runs/r1/trajectories/feature?format=json&alignment=sim3']);
    expect(viewing.socket.types(), 'the 3D view stays').not.toContain('align');
    expect(values()?.slice(2)).toEqual([['feature by sim3', 7]]);
    const dashes = plotSpecs(state, 'pose')[0]?.curves.map(
      ({ hue }) => curveStyle(hue).dash.length,
    );
    expect(dashes).toEqual([0, 0, 2]);
    viewing.session.showTrack('r1', 'feature', false);
    expect(values()).toHaveLength(1);
    viewing.session.showTrack('r1', 'feature', true);
    await chosen.compare('init_scale');
    expect(state.main?.compared?.estimates).toBe(state.main?.data.estimates);
    await chosen.compare(null);
    expect(drawnTracks(state).map(({ label }) => label)).toEqual(['truth', 'feature']);
  });

  it('leaves what was drawn by an alignment that is not chosen any more', async () => {
    const { state } = viewing.store;
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    const chosen = alignment();
    await chosen.compare('sim3');
    expect(state.main?.compared?.mode).toBe('sim3');
    // Its score has no transform.
    await chosen.compare('se3');
    expect(state.compared).toBe('se3');
    expect(state.main?.compared).toBeNull();
    // No score has it: it comes from a link.
    await chosen.compare('sim3');
    await chosen.compare('foo');
    expect(state.compared).toBeNull();
    expect(state.main?.compared).toBeNull();
    await chosen.choose('foo');
    expect(state.alignment).toBe('init_scale');
  });

  it('asks again for a second alignment that could not be read', async () => {
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    const read = answer;
    answer = () => Response.json({ error: { code: 'internal', message: 'no' } }, { status: 500 });
    const chosen = alignment();
    await chosen.compare('sim3');
    expect(viewing.store.state.main?.compared).toBeNull();
    answer = read;
    await chosen.compare('sim3');
    expect(viewing.store.state.main?.compared?.mode).toBe('sim3');
  });

  it('knows the scale of each alignment', async () => {
    const alignments = { init_scale: { scale: 2 }, sim3: { scale: 3, S_world_vo: {} } };
    const scored = { estimators: { feature: { outcome: 'COMPLETED', alignments } } };
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics: scored });
    await alignment().compare('sim3');
    expect(drawnTracks(viewing.store.state).map(scaleOf)).toEqual([null, 2, 3]);
  });

  it('stays with what rows say where the score has no transform', async () => {
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    await alignment().choose('se3');
    expect(asked).toEqual([]);
    expect(viewing.store.state.alignment).toBe('se3');
    expect(shownAlignment(viewing.store.state)).toBe('init_scale');
    expect(canBeDrawn(metrics, 'sim3')).toBe(true);
    expect(canBeDrawn(null, 'sim3')).toBe(false);
  });

  it('asks once for what the server refuses', async () => {
    answer = () => Response.json({ error: { code: 'conflict', message: 'no' } }, { status: 409 });
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    const chosen = alignment();
    await chosen.choose('sim3');
    await chosen.refresh();
    expect(asked).toHaveLength(1);
    expect(shownAlignment(viewing.store.state)).toBe('init_scale');
    expect(viewing.store.state.notices).toEqual([]);
  });

  it('is asked for again after a lost connection', async () => {
    viewing.socket.receive({ type: 'metrics', run: 'r1', metrics });
    await alignment().choose('sim3');
    viewing.socket.lose();
    viewing.timers.fire();
    viewing.socket.hello();
    expect(viewing.socket.types()).toContain('align');
  });
});

describe('Cameras', () => {
  it('are read once a run has frames', async () => {
    answer = () => Response.json({ cameras: [{ name: 'front', width_px: 64, height_px: 48 }] });
    const cameras = new Cameras(viewing.store, rest(), () => undefined);
    viewing.socket.receive(playbackMessage({ frame: -1 }));
    await cameras.refresh();
    expect(asked).toEqual([]);
    viewing.socket.receive(playbackMessage());
    await cameras.refresh();
    await cameras.refresh();
    expect(asked).toEqual(['api/runs/r1/manifest']);
    expect(viewing.store.state.cameras.map(({ name }) => name)).toEqual(['front']);
  });
});
