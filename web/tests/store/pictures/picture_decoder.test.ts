import { describe, expect, it, vi } from 'vitest';
import type { PictureMessage } from '../../../src/protocol/parse';
import { sampleHeader } from '../../support/encode_picture';
import { PictureDecoder } from '../../../src/store/pictures/picture_decoder';

function message(frame: number): PictureMessage {
  return {
    ...sampleHeader({ sequence: frame, frame, t_ns: frame }),
    jpeg: Uint8Array.of(frame),
  };
}

/** Decodes on request. */
function decoder() {
  const waiting: { resolve: (bitmap: ImageBitmap) => void; reject: (reason: Error) => void }[] = [];
  const shown: number[] = [];
  const faults: string[] = [];
  const close = vi.fn();
  const pictures = new PictureDecoder(
    () => new Promise((resolve, reject) => waiting.push({ resolve, reject })),
    (_, { frame }) => shown.push(frame),
    (text) => faults.push(text),
  );
  const finish = async () => {
    waiting.shift()?.resolve({ close } as unknown as ImageBitmap);
    await new Promise((resolve) => setTimeout(resolve));
  };
  const fail = async () => {
    waiting.shift()?.reject(new Error('bad'));
    await new Promise((resolve) => setTimeout(resolve));
  };
  return { pictures, shown, faults, close, finish, fail, waiting };
}

describe('PictureDecoder', () => {
  it('decodes one at a time and skips to the newest', async () => {
    const { pictures, shown, finish } = decoder();
    for (const frame of [1, 2, 3]) pictures.push('camera', message(frame));
    await finish();
    await finish();
    expect(shown).toEqual([1, 3]);
  });

  it('goes on after a picture that cannot be decoded', async () => {
    const { pictures, shown, faults, finish, fail } = decoder();
    pictures.push('camera', message(1));
    await fail();
    pictures.push('camera', message(2));
    await finish();
    expect(shown).toEqual([2]);
    expect(faults).toEqual(['picture of frame 1 of camera cannot be decoded']);
  });

  it('shows nothing of what was under way when cleared', async () => {
    const { pictures, shown, close, finish } = decoder();
    pictures.push('camera', message(1));
    pictures.clear();
    await finish();
    expect(shown).toEqual([]);
    expect(close).toHaveBeenCalledOnce();
  });
});
