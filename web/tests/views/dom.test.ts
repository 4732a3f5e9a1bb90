import { afterEach, beforeEach, expect, test, vi } from 'vitest';
import { perFrame, promptlyPerFrame } from '../../src/views/dom';

let frames: (() => void)[] = [];

function nextFrame(): void {
  const due = frames;
  frames = [];
  for (const frame of due) frame();
}

beforeEach(() => {
  frames = [];
  vi.stubGlobal('requestAnimationFrame', (frame: () => void) => frames.push(frame));
});
afterEach(() => vi.unstubAllGlobals());

test('an action per frame waits for the frame and takes the latest value', () => {
  const taken: number[] = [];
  const act = perFrame<number>((value) => taken.push(value));
  act(1);
  act(2);
  expect(taken).toEqual([]);
  nextFrame();
  nextFrame();
  expect(taken).toEqual([2]);
});

test('a prompt action is taken at once, and then once per frame with the latest value', () => {
  const taken: number[] = [];
  const act = promptlyPerFrame<number>((value) => taken.push(value));
  act(1);
  expect(taken).toEqual([1]);
  act(2);
  act(3);
  expect(taken).toEqual([1]);
  nextFrame();
  expect(taken).toEqual([1, 3]);
  act(4);
  expect(taken).toEqual([1, 3]);
  nextFrame();
  nextFrame();
  expect(taken).toEqual([1, 3, 4]);
  act(5);
  expect(taken).toEqual([1, 3, 4, 5]);
});
