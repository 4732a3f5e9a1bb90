// Decodes the pictures of a run's streams and shows them in order. Of JPEGs only the newest counts;
// video pictures need each other, so that none may be left out.
import type { PictureMessage } from '../../protocol/parse';
import type { DecodedImage, Picture } from '../watched_run';
import type { OpenVideo, VideoDecoding } from './video_decoding';

export type Decode = (jpeg: Blob) => Promise<ImageBitmap>;

export interface DecoderEvents {
  done(name: string, picture: Picture): void;
  /** Shown, or not to be shown any more. */
  settled(streamId: number, sequence: number): void;
  failed(text: string): void;
  /** A video picture is missing: the chain must start again with a key picture. */
  lost(streamId: number): void;
  /** Video fails again and again. */
  videoFailed(): void;
}

interface Stream {
  busy: boolean;
  next: PictureMessage | null;
  /** Number of the newest picture shown. */
  shown: number;
  video: VideoDecoding | null;
  /** The decoder has all pictures since the last key picture. */
  chained: boolean;
  /** Video pictures that are being decoded, by their number. */
  coming: Map<number, PictureMessage>;
}

/** More than this waits only where decoding is too slow. */
const kMostWaiting = 8;
const kMostFailures = 3;

export class PictureDecoder {
  private streams = new Map<string, Stream>();
  private epoch = 0;
  private failures = 0;

  constructor(
    private readonly decode: Decode,
    private readonly openVideo: OpenVideo,
    private readonly events: DecoderEvents,
  ) {}

  push(name: string, message: PictureMessage): void {
    let stream = this.streams.get(name);
    if (stream === undefined) {
      stream = {
        busy: false,
        next: null,
        shown: -1,
        video: null,
        chained: false,
        coming: new Map(),
      };
      this.streams.set(name, stream);
    }
    if (message.encoding === 'vp8') {
      this.pushVideo(name, stream, message);
      return;
    }
    // While one picture is being decoded, only the newest of the others waits.
    stream.next = message;
    if (!stream.busy) void this.run(name, stream);
  }

  /** Discards pictures in progress, because they belong to another run or connection. */
  clear(): void {
    this.epoch += 1;
    for (const { video } of this.streams.values()) video?.close();
    this.streams.clear();
  }

  private async run(name: string, stream: Stream): Promise<void> {
    const epoch = this.epoch;
    stream.busy = true;
    while (stream.next !== null) {
      const message = stream.next;
      stream.next = null;
      try {
        const bitmap = await this.decode(new Blob([message.data], { type: 'image/jpeg' }));
        if (epoch !== this.epoch) {
          bitmap.close();
          return;
        }
        this.show(name, stream, message, bitmap);
      } catch {
        this.events.settled(message.streamId, message.sequence);
        this.events.failed(`picture of frame ${message.frame} of ${name} cannot be decoded`);
      }
    }
    stream.busy = false;
  }

  private pushVideo(name: string, stream: Stream, message: PictureMessage): void {
    if (message.key) stream.chained = true;
    const late = stream.video !== null && stream.video.waiting > kMostWaiting && !message.key;
    if (!stream.chained || late) {
      this.lose(stream, message);
      return;
    }
    stream.video ??= this.open(name, stream);
    stream.coming.set(message.sequence, message);
    try {
      stream.video.decode(message);
    } catch {
      this.breakVideo(stream);
    }
  }

  /** Leaves out a picture that cannot be decoded, or not in time. */
  private lose(stream: Stream, { streamId, sequence }: PictureMessage): void {
    stream.chained = false;
    this.events.settled(streamId, sequence);
    this.events.lost(streamId);
  }

  private open(name: string, stream: Stream): VideoDecoding {
    const epoch = this.epoch;
    return this.openVideo({
      decoded: (sequence, frame) => {
        const message = stream.coming.get(sequence);
        for (const earlier of stream.coming.keys()) {
          if (earlier <= sequence) stream.coming.delete(earlier);
        }
        if (epoch !== this.epoch || message === undefined) {
          frame.close();
          return;
        }
        this.failures = 0;
        this.show(name, stream, message, frame);
      },
      failed: () => {
        if (epoch === this.epoch) this.breakVideo(stream);
      },
    });
  }

  private breakVideo(stream: Stream): void {
    stream.video?.close();
    stream.video = null;
    stream.chained = false;
    const last = [...stream.coming.values()].at(-1);
    stream.coming.clear();
    this.failures += 1;
    if (last === undefined) return;
    this.events.settled(last.streamId, last.sequence);
    if (this.failures >= kMostFailures) this.events.videoFailed();
    else this.events.lost(last.streamId);
  }

  private show(name: string, stream: Stream, message: PictureMessage, bitmap: DecodedImage): void {
    this.events.settled(message.streamId, message.sequence);
    // A video picture may overtake a JPEG that was sent before it.
    if (message.sequence < stream.shown) {
      bitmap.close();
      return;
    }
    stream.shown = message.sequence;
    const { frame, t_ns, width_px, height_px, live, scale, fullWidth_px, fullHeight_px } = message;
    const { labels = [] } = message;
    const size = { width_px, height_px, fullWidth_px, fullHeight_px };
    this.events.done(name, { frame, t_ns, ...size, live, scale, labels, bitmap });
  }
}
