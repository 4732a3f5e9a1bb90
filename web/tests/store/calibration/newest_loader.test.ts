import { beforeEach, describe, expect, it } from 'vitest';
import { NewestLoader } from '../../../src/store/calibration/newest_loader';

let loading: { wanted: number; resolve: (text: string) => void; reject: (why: Error) => void }[];
let shown: [number, string][];
let loader: NewestLoader<number, string>;

beforeEach(() => {
  loading = [];
  shown = [];
  loader = new NewestLoader(
    (wanted) => new Promise((resolve, reject) => loading.push({ wanted, resolve, reject })),
    (wanted, text) => shown.push([wanted, text]),
  );
});

const settle = () => new Promise((resolve) => setTimeout(resolve, 0));
const wanted = () => loading.map((one) => one.wanted);

describe('NewestLoader', () => {
  it('shows each image that comes, although newer ones are wanted meanwhile', async () => {
    for (const image of [1, 2, 3]) loader.want(image);
    expect(wanted(), 'one at a time').toEqual([1]);
    loading[0]?.resolve('a');
    await settle();
    expect(shown).toEqual([[1, 'a']]);
    expect(wanted(), 'the newest of those that wait').toEqual([1, 3]);
    loader.want(4);
    loading[1]?.resolve('c');
    await settle();
    loading[2]?.resolve('d');
    await settle();
    expect(shown.slice(1)).toEqual([
      [3, 'c'],
      [4, 'd'],
    ]);
    loader.want(5);
    expect(wanted().at(-1)).toBe(5);
  });

  it('goes on with the next image if one cannot be loaded', async () => {
    loader.want(1);
    loader.want(2);
    loading[0]?.reject(new Error('gone'));
    await settle();
    loading[1]?.resolve('b');
    await settle();
    expect(shown).toEqual([[2, 'b']]);
  });

  it('drops what comes after nothing was wanted any more', async () => {
    loader.want(1);
    loader.want(2);
    loader.clear();
    loading[0]?.resolve('a');
    await settle();
    expect(shown).toEqual([]);
    expect(wanted()).toEqual([1]);
    loader.want(3);
    loading[1]?.resolve('c');
    await settle();
    expect(shown).toEqual([[3, 'c']]);
  });
});
