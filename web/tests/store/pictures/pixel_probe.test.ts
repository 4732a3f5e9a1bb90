import { describe, expect, it } from 'vitest';
import type { RestClient } from '../../../src/connection/rest_client';
import type { PixelAnswer, PixelQuestion } from '../../../src/protocol/pixel_types';
import { PixelProbe, pixelTexts } from '../../../src/store/pictures/pixel_probe';
import { Store } from '../../../src/store/state';

const kQuestion: PixelQuestion = {
  run: 'r1',
  frame: 7,
  x_px: 100.25,
  y_px: 50,
  camera: null,
  picture: 'camera',
  alignment: 'init_scale',
};
const kAnswer: PixelAnswer = {
  frame: 7,
  t_ns: 0,
  camera: 'camera0',
  width_px: 1280,
  height_px: 960,
  grey: 131,
  rgb: null,
  difference: null,
  ground: {
    lat_deg: 39.3459056,
    lon_deg: -86.0321792,
    alt_ellipsoid_m: 227.71,
    x_m: 1,
    y_m: 2,
    z_m: 3,
  },
  depth_m: 300,
  range_m: 313.13,
};

/** A server that answers when the test says so. */
function probing() {
  const asked: PixelQuestion[] = [];
  const waiting: { resolve: (answer: PixelAnswer) => void; reject: (error: Error) => void }[] = [];
  const rest = {
    pixel: (question: PixelQuestion) => {
      asked.push(question);
      return new Promise<PixelAnswer>((resolve, reject) => waiting.push({ resolve, reject }));
    },
  };
  const store = new Store();
  const probe = new PixelProbe(store, rest as unknown as RestClient, (then) => then());
  const settle = async () => {
    for (let i = 0; i < 8; i++) await Promise.resolve();
  };
  return { asked, waiting, store, probe, settle };
}

describe('PixelProbe', () => {
  it('asks for one pixel at a time, and only for the newest of the others', async () => {
    const { asked, waiting, store, probe, settle } = probing();
    probe.point({ run: 'r1', group: 'camera', x: 0.1, y: 0.1 });
    for (const frame of [1, 2, 3]) probe.ask({ ...kQuestion, frame });
    expect(asked.map(({ frame }) => frame)).toEqual([1]);
    waiting[0]?.resolve(kAnswer);
    await settle();
    expect(asked.map(({ frame }) => frame)).toEqual([1, 3]);
    expect(store.state.pixel?.question.frame).toBe(1);
    waiting[1]?.resolve(kAnswer);
    await settle();
    probe.ask({ ...kQuestion, frame: 3 });
    expect(asked, 'the same question again').toHaveLength(2);
  });

  it('shows why there is no answer', async () => {
    const { waiting, store, probe, settle } = probing();
    probe.point({ run: 'r1', group: 'camera', x: 0.1, y: 0.1 });
    probe.ask(kQuestion);
    waiting[0]?.reject(new Error('no such frame'));
    await settle();
    expect(store.state.pixel?.answer).toBe('no such frame');
  });

  it('forgets the pixel when the mouse leaves, also one that is still to be answered', async () => {
    const { waiting, store, probe, settle } = probing();
    probe.point({ run: 'r1', group: 'camera', x: 0.1, y: 0.1 });
    probe.ask(kQuestion);
    probe.point(null);
    waiting[0]?.resolve(kAnswer);
    await settle();
    expect(store.state.pixel).toBeNull();
    expect(store.state.hover).toBeNull();
  });

  it('shows no answer about a picture that the mouse has left for one that asks nothing', async () => {
    const { asked, waiting, store, probe, settle } = probing();
    probe.point({ run: 'r1', group: 'camera', x: 0.1, y: 0.1 });
    probe.ask(kQuestion);
    probe.ask({ ...kQuestion, frame: 8 });
    probe.point({ run: 'r1', group: 'debug/feature', x: 0.1, y: 0.1 });
    probe.askNothing();
    waiting[0]?.resolve(kAnswer);
    await settle();
    expect(store.state.pixel).toBeNull();
    expect(asked).toHaveLength(1);
    probe.ask(kQuestion);
    waiting[1]?.resolve(kAnswer);
    await settle();
    expect(store.state.pixel?.answer).toEqual(kAnswer);
  });

  it('reads out grey level, place, height and range', () => {
    expect(pixelTexts(kQuestion, kAnswer)).toEqual([
      'x 100.3  y 50.0 px',
      'grey 131',
      '39.345906° N  86.032179° W',
      'height 227.7 m',
      'range 313.1 m',
    ]);
    const sky = { ...kAnswer, ground: null, rgb: [1, 2, 3] as [number, number, number] };
    expect(pixelTexts(kQuestion, { ...sky, difference: -4 })).toEqual([
      'x 100.3  y 50.0 px',
      'grey 131 (1 2 3)',
      'difference −4',
      'sky',
    ]);
  });
});
