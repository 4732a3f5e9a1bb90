import { describe, expect, it } from 'vitest';
import { sceneWish } from '../../../src/views/scene/scene_wish';
import { sampleRun } from '../../support/samples';
import { Viewing } from '../../support/viewing';

describe('the picture of the 3D view', () => {
  it('has the runs of which a track is shown, in the colours of their tracks', () => {
    const viewing = new Viewing();
    viewing.watch();
    const { session, socket, store } = viewing;
    for (const id of ['r2', 'r3']) {
      session.addRun(id);
      socket.receive({ type: 'run', run: sampleRun({ id, estimators: ['a', 'b'] }) });
    }
    const others = () => sceneWish(store.state)[0]?.with;
    const [r2, r3] = [
      { run: 'r2', first_colour: 1 },
      { run: 'r3', first_colour: 3 },
    ];
    expect(others()).toEqual([r2, r3]);
    for (const name of ['', 'a']) session.showTrack('r2', name, false);
    expect(others(), 'b is shown').toEqual([{ ...r2, hide: ['', 'a'] }, r3]);
    session.showTrack('r2', 'b', false);
    expect(others()).toEqual([r3]);
    for (const name of ['', 'feature']) session.showTrack('r1', name, false);
    const [own] = sceneWish(store.state);
    expect([own?.run, own?.hide], 'the main run stays, without its tracks').toEqual([
      'r1',
      ['', 'feature'],
    ]);
  });

  it('has the alignment that is compared with the first', () => {
    const viewing = new Viewing();
    viewing.watch();
    expect(sceneWish(viewing.store.state)[0]).not.toHaveProperty('compared');
    viewing.store.state.compared = 'sim3';
    expect(sceneWish(viewing.store.state)[0]?.compared).toBe('sim3');
  });

  it('has the colours that the viewer chose', () => {
    const viewing = new Viewing();
    viewing.watch();
    viewing.store.state.colours = new Map([
      ['r1/', '102030'],
      ['r1/feature', '6'],
    ]);
    expect(sceneWish(viewing.store.state)[0]?.colours).toEqual({
      '': '#102030',
      feature: '#e678bf',
    });
  });
});
