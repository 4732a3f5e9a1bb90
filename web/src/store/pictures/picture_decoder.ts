// Decodes pictures asynchronously and keeps the newest of each stream.
import type { PictureMessage } from '../../protocol/parse';
import type { Picture } from '../watched_run';

export type Decode = (jpeg: Blob) => Promise<ImageBitmap>;

interface Stream {
  busy: boolean;
  next: PictureMessage | null;
}

export class PictureDecoder {
  private streams = new Map<string, Stream>();
  private epoch = 0;

  constructor(
    private readonly decode: Decode,
    private readonly done: (name: string, picture: Picture) => void,
    private readonly failed: (text: string) => void,
  ) {}

  /** While one picture of a stream is being decoded, only the newest of the others waits. */
  push(name: string, message: PictureMessage): void {
    let stream = this.streams.get(name);
    if (stream === undefined) {
      stream = { busy: false, next: null };
      this.streams.set(name, stream);
    }
    stream.next = message;
    if (!stream.busy) void this.run(name, stream);
  }

  /** Discards pictures in progress, because they belong to the previous run. */
  clear(): void {
    this.epoch += 1;
    this.streams.clear();
  }

  private async run(name: string, stream: Stream): Promise<void> {
    const epoch = this.epoch;
    stream.busy = true;
    while (stream.next !== null) {
      const message = stream.next;
      stream.next = null;
      try {
        const bitmap = await this.decode(new Blob([message.jpeg], { type: 'image/jpeg' }));
        if (epoch !== this.epoch) {
          bitmap.close();
          return;
        }
        const { frame, t_ns, width_px, height_px, live } = message;
        const { scale, fullWidth_px, fullHeight_px } = message;
        const size = { width_px, height_px, fullWidth_px, fullHeight_px };
        const { labels = [] } = message;
        this.done(name, { frame, t_ns, ...size, live, scale, labels, bitmap });
      } catch {
        this.failed(`picture of frame ${message.frame} of ${name} cannot be decoded`);
      }
    }
    stream.busy = false;
  }
}
