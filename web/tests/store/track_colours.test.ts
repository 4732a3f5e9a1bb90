import { describe, expect, it } from 'vitest';
import { plotSpecs } from '../../src/store/plots/plot_specs';
import { colourKey, coloursOf, isTrackColour, TrackColours } from '../../src/store/track_colours';
import { tracksOf } from '../../src/store/tracks';
import { curveStyle, trackColour } from '../../src/views/colours';
import { sampleRun } from '../support/samples';
import { Viewing } from '../support/viewing';

class FakeStorage {
  constructor(public text: string | null = null) {}
  getItem(): string | null {
    return this.text;
  }
  setItem(_key: string, text: string): void {
    this.text = text;
  }
}

describe('colours of tracks', () => {
  it('are those that the viewer chose, in every plot, until that is undone', () => {
    const viewing = new Viewing();
    viewing.watch();
    const { state } = viewing.store;
    const colours = new TrackColours(viewing.store, new FakeStorage());
    colours.choose('r1', 'feature', '3');
    colours.choose('r1', '', '00ff00');
    expect(tracksOf(state).map(trackColour)).toEqual(['#00ff00', 'var(--estimate-3)']);
    const hues = plotSpecs(state, 'pose')[0]?.curves.map(({ hue }) => curveStyle(hue).colour);
    expect(hues).toEqual(['#00ff00', 'var(--estimate-3)']);
    colours.choose('r1', 'feature', null);
    expect(tracksOf(state).map(trackColour)).toEqual(['#00ff00', 'var(--estimate-1)']);
  });

  it('are kept by the browser, those of a run apart from the others', () => {
    const storage = new FakeStorage();
    const first = new TrackColours(new Viewing().store, storage);
    first.choose('r1', 'a/b', '2');
    first.choose('r11', 'a', '123abc');
    const { store } = new Viewing();
    new TrackColours(store, storage);
    expect(coloursOf(store.state.colours, 'r1')).toEqual(new Map([['a/b', '2']]));
    expect(store.state.colours.get(colourKey('r11', 'a'))).toBe('123abc');
  });

  it('of a link are not kept, and replace none that are', () => {
    const storage = new FakeStorage();
    const { store } = new Viewing();
    const colours = new TrackColours(store, storage);
    colours.choose('r1', 'a', '2');
    store.state.colours = new Map([[colourKey('r1', 'b'), '5']]);
    colours.choose('r2', 'c', '3');
    expect(store.state.colours.get(colourKey('r1', 'b'))).toBe('5');
    const next = new Viewing().store;
    new TrackColours(next, storage);
    expect([...next.state.colours]).toEqual([
      ['r1/a', '2'],
      ['r2/c', '3'],
    ]);
  });

  it.each(['{', '7', '[["r/a","red"],["r/b","2"],[1,"2"],"x"]', null])(
    'leave out of the storage what is none: %s',
    (text) => {
      const { store } = new Viewing();
      new TrackColours(store, new FakeStorage(text));
      const kept = text?.includes('r/b') === true ? [['r/b', '2']] : [];
      expect([...store.state.colours]).toEqual(kept);
    },
  );

  it.each(['0', '7', '12', 'red', '#ff0000', 'FF0000', 'ff00001', '', null])(
    'are not %s',
    (text) => {
      expect(isTrackColour(text)).toBe(false);
    },
  );

  it('begin again with dashes after the sixth estimate', () => {
    const viewing = new Viewing();
    viewing.watch();
    const estimators = Array.from({ length: 14 }, (_, i) => `e${i}`);
    viewing.socket.receive({ type: 'run', run: sampleRun({ estimators }) });
    const specs = plotSpecs(viewing.store.state, 'pose')[0]?.curves ?? [];
    const styles = specs.map(({ hue }) => JSON.stringify(curveStyle(hue)));
    expect(styles).toHaveLength(15);
    expect(new Set(styles).size).toBe(15);
    expect(curveStyle({ kind: 'estimate', colour: 6 }).dash).not.toEqual([]);
    expect(curveStyle({ kind: 'estimate', colour: 6 }).colour).toBe('var(--estimate-1)');
  });
});
