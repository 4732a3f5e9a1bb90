import { describe, expect, it } from 'vitest';
import { PlotTime } from '../../../src/store/plots/plot_time';
import { playbackMessage } from '../../support/samples';
import { Viewing } from '../../support/viewing';

/** A flight of 100 s, zoomed to its part from 20 to 30 s. */
function zoomedIn() {
  const viewing = new Viewing();
  viewing.watch();
  const goTo = (t_s: number, change = {}) =>
    viewing.socket.receive(playbackMessage({ t_ns: t_s * 1e9, end_ns: 100e9, ...change }));
  goTo(25);
  const time = new PlotTime(viewing.store);
  time.follow();
  time.zoom(200 / 9, 0.1);
  return { viewing, time, goTo };
}

describe('PlotTime', () => {
  it('shows the whole flight until it is zoomed, and again', () => {
    const { time, viewing } = zoomedIn();
    expect(time.whole_s).toEqual([0, 100]);
    expect(time.part_s?.[0]).toBeCloseTo(20);
    expect(time.part_s?.[1]).toBeCloseTo(30);
    viewing.store.take();
    time.showWhole();
    expect(time.part_s).toBeNull();
    expect(time.shown_s).toEqual([0, 100]);
    expect([...viewing.store.take()]).toEqual(['plotTime']);
  });

  it('gives the part by the time of a run that begins later on the clock', () => {
    const { time, viewing } = zoomedIn();
    viewing.session.setOffset('r1', 18e9);
    expect(time.part_s?.[0]).toBeCloseTo(20);
    expect(time.partOfRun_s?.[0]).toBeCloseTo(2);
    expect(time.partOfRun_s?.[1]).toBeCloseTo(12);
    time.showWhole();
    expect(time.partOfRun_s).toBeNull();
  });

  it('moves inside the flight; all of it does not move', () => {
    const { time } = zoomedIn();
    time.pan(15);
    expect(time.part_s?.[0]).toBeCloseTo(35);
    time.pan(500);
    expect(time.part_s?.[1]).toBeCloseTo(100);
    expect(time.part_s?.[0]).toBeCloseTo(90);
    time.showWhole();
    time.pan(5);
    expect(time.part_s).toBeNull();
  });

  it('zooms about the clock, or about the middle if the clock is elsewhere', () => {
    const { time } = zoomedIn();
    time.zoomAtClock(0.5);
    expect(time.part_s?.[0]).toBeCloseTo(22.5);
    time.pan(20);
    time.zoomAtClock(0.5);
    expect(time.part_s?.[0]).toBeCloseTo(43.75);
    expect(time.part_s?.[1]).toBeCloseTo(46.25);
  });

  it('follows the clock out of the part', () => {
    const { time, goTo } = zoomedIn();
    goTo(30.1, { playing: true });
    time.follow();
    expect(time.part_s?.[0]).toBeCloseTo(29.1);
  });

  it('stays where the viewer has moved it while the flight plays on, until the clock jumps', () => {
    const { time, goTo } = zoomedIn();
    time.pan(40);
    goTo(25.05, { playing: true });
    time.follow();
    expect(time.part_s?.[0]).toBeCloseTo(60);
    goTo(80);
    time.follow();
    expect(time.part_s?.[0]).toBeCloseTo(79);
  });

  it('stays until the clock is at the time of an address, unless it plays', () => {
    const { time, viewing, goTo } = zoomedIn();
    const link = { span_s: [50, 60] as const, waits_ns: 55e9 };
    viewing.store.state.plotWindow = link;
    goTo(0);
    time.follow();
    expect(time.part_s).toEqual([50, 60]);
    goTo(55);
    time.follow();
    expect(time.part_s).toEqual([50, 60]);
    goTo(10);
    time.follow();
    expect(time.part_s).toEqual([1, 11]);
    viewing.store.state.plotWindow = link;
    goTo(30, { playing: true });
    time.follow();
    expect(time.part_s?.[0]).toBeCloseTo(21);
  });

  it('shows other runs whole', () => {
    const { time, viewing } = zoomedIn();
    viewing.session.addRun('r2', 0);
    expect(time.part_s).toBeNull();
  });
});
