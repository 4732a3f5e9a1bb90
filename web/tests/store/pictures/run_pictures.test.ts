import { beforeEach, describe, expect, it, vi } from 'vitest';
import { Notices } from '../../../src/store/notices';
import { PictureWishes } from '../../../src/store/pictures/picture_wishes';
import { RunPictures } from '../../../src/store/pictures/run_pictures';
import { Store } from '../../../src/store/state';
import { WatchedRun } from '../../../src/store/watched_run';
import { sampleHeader } from '../../support/encode_picture';

const kError = { type: 'error', code: 'io', message: 'no tile' } as const;

let store: Store;
let wishes: PictureWishes;
let pictures: RunPictures;
let watched: WatchedRun;
const close = vi.fn();
const settled = vi.fn();
const settle = () => new Promise((resolve) => setTimeout(resolve, 0));

beforeEach(() => {
  vi.clearAllMocks();
  store = new Store();
  wishes = new PictureWishes();
  watched = new WatchedRun('r1');
  store.state.watched = [watched];
  pictures = new RunPictures(
    store,
    new Notices(store, () => undefined),
    wishes,
    () => Promise.resolve({ close } as unknown as ImageBitmap),
    () => {
      throw new Error('no video here');
    },
    { settled, lost: () => undefined, videoFailed: () => undefined },
    () => 0,
  );
  pictures.watch(watched);
});

function take(name: string, sequence = 0): Promise<unknown> {
  pictures.take('r1', name, { ...sampleHeader({ sequence }), data: new Uint8Array(1) });
  return settle();
}

describe('RunPictures', () => {
  it('keeps why a picture cannot be drawn until it comes', async () => {
    wishes.set('camera', [{ run: 'r1', name: 'camera', camera: 'left' }]);
    pictures.refuse({ ...kError, run: 'r1', picture: 'camera' });
    pictures.refuse({ ...kError, run: 'r1', picture: 'depth' });
    expect([...watched.refusals]).toEqual([
      ['camera', 'no tile'],
      ['depth', 'no tile'],
    ]);
    expect(store.state.notices.map(({ text }) => text)).toEqual(['no tile']);
    await take('camera?camera=left');
    expect([...watched.refusals.keys()]).toEqual(['depth']);
    pictures.clear();
    expect(watched.refusals.size, 'of a new connection').toBe(0);
  });

  it('shows other errors as a message only', () => {
    pictures.refuse(kError);
    expect(store.state.notices).toHaveLength(1);
    expect(watched.refusals.size).toBe(0);
  });

  it('keeps no picture that comes after its panel is hidden', async () => {
    const shot = { run: 'r1', name: 'scene', view: 'shot' };
    wishes.set('shot', [shot]);
    await take('scene?view=shot', 1);
    expect(watched.pictures.has('scene?view=shot')).toBe(true);
    watched.pictures.clear();
    wishes.set('shot', []);
    await take('scene?view=shot', 2);
    expect(watched.pictures.size).toBe(0);
    expect(close).toHaveBeenCalledTimes(1);
    expect(settled, 'the server may send more').toHaveBeenCalledTimes(2);
  });
});
