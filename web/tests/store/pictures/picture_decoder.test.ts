import { describe, expect, it, vi } from 'vitest';
import type { PictureMessage } from '../../../src/protocol/parse';
import { sampleHeader } from '../../support/encode_picture';
import { PictureDecoder } from '../../../src/store/pictures/picture_decoder';
import type { VideoEvents } from '../../../src/store/pictures/video_decoding';

function message(frame: number): PictureMessage {
  return {
    ...sampleHeader({ sequence: frame, frame, t_ns: frame }),
    data: Uint8Array.of(frame),
  };
}

function video(sequence: number, key = false): PictureMessage {
  return { ...message(sequence), encoding: 'vp8', key };
}

/** Decodes on request. */
function decoder() {
  const waiting: { resolve: (bitmap: ImageBitmap) => void; reject: (reason: Error) => void }[] = [];
  const videos: { events: VideoEvents; decoded: number[]; waiting: number; closed: boolean }[] = [];
  const shown: number[] = [];
  const settled: number[] = [];
  const faults: string[] = [];
  const lost: number[] = [];
  const videoFailed = vi.fn();
  const close = vi.fn();
  const pictures = new PictureDecoder(
    () => new Promise((resolve, reject) => waiting.push({ resolve, reject })),
    (events) => {
      const one = { events, decoded: [] as number[], waiting: 0, closed: false };
      videos.push(one);
      return {
        decode: ({ sequence }) => one.decoded.push(sequence),
        close: () => {
          one.closed = true;
        },
        get waiting() {
          return one.waiting;
        },
      };
    },
    {
      done: (_, { frame }) => shown.push(frame),
      settled: (_, sequence) => settled.push(sequence),
      failed: (text) => faults.push(text),
      lost: (streamId) => lost.push(streamId),
      videoFailed,
    },
  );
  const finish = async () => {
    waiting.shift()?.resolve({ close } as unknown as ImageBitmap);
    await new Promise((resolve) => setTimeout(resolve));
  };
  const fail = async () => {
    waiting.shift()?.reject(new Error('bad'));
    await new Promise((resolve) => setTimeout(resolve));
  };
  const decoded = (sequence: number) =>
    videos.at(-1)?.events.decoded(sequence, { close } as unknown as VideoFrame);
  return {
    ...{ pictures, shown, settled, faults, lost, videoFailed, close, finish, fail },
    ...{ videos, decoded },
  };
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

  it('decodes every video picture in order, and tells which are shown', () => {
    const { pictures, shown, settled, videos, decoded } = decoder();
    pictures.push('camera', video(1, true));
    pictures.push('camera', video(2));
    expect(videos[0]?.decoded).toEqual([1, 2]);
    decoded(1);
    decoded(2);
    expect(shown).toEqual([1, 2]);
    expect(settled).toEqual([1, 2]);
  });

  it('asks for a key picture where the video does not begin with one', () => {
    const { pictures, lost, settled, videos } = decoder();
    pictures.push('camera', video(4));
    expect(videos).toEqual([]);
    expect(settled).toEqual([4]);
    expect(lost).toEqual([1]);
  });

  it('starts again with a key picture where decoding is too slow', () => {
    const { pictures, lost, videos } = decoder();
    pictures.push('camera', video(1, true));
    if (videos[0]) videos[0].waiting = 9;
    pictures.push('camera', video(2));
    pictures.push('camera', video(3));
    expect(lost).toEqual([1, 1]);
    pictures.push('camera', video(4, true));
    expect(videos[0]?.decoded).toEqual([1, 4]);
  });

  it('gives video up after it has failed three times without a picture in between', () => {
    const { pictures, lost, videoFailed, videos, decoded } = decoder();
    const failOnce = (sequence: number) => {
      pictures.push('camera', video(sequence, true));
      videos.at(-1)?.events.failed();
    };
    failOnce(1);
    failOnce(2);
    pictures.push('camera', video(3, true));
    decoded(3);
    failOnce(4);
    failOnce(5);
    expect(videoFailed).not.toHaveBeenCalled();
    failOnce(6);
    expect(videoFailed).toHaveBeenCalledOnce();
    expect(lost).toEqual([1, 1, 1, 1]);
    expect(videos.slice(0, 2).map(({ closed }) => closed)).toEqual([true, true]);
  });

  it('does not show a JPEG after a later video picture', async () => {
    const { pictures, shown, close, finish, decoded } = decoder();
    pictures.push('camera', message(1));
    pictures.push('camera', video(2, true));
    decoded(2);
    await finish();
    expect(shown).toEqual([2]);
    expect(close).toHaveBeenCalledOnce();
  });
});
