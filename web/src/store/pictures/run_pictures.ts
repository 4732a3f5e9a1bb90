// The pictures of the watched runs: decoded and kept in their run, or why they cannot be drawn.
import type { ServerMessage } from '../../protocol/messages';
import type { PictureMessage } from '../../protocol/parse';
import type { Notices } from '../notices';
import type { Store } from '../state';
import type { WatchedRun } from '../watched_run';
import type { Decode } from './picture_decoder';
import { PictureDecoder } from './picture_decoder';
import type { PictureWishes } from './picture_wishes';
import type { OpenVideo } from './video_decoding';

/** To the server. */
export interface PictureAnswers {
  /** A picture was shown, or will not be. */
  settled(streamId: number, sequence: number): void;
  /** A video picture was lost: asks for one that does not need it. */
  lost(streamId: number): void;
  videoFailed(): void;
}

export class RunPictures {
  private readonly decoders = new Map<string, PictureDecoder>();

  constructor(
    private readonly store: Store,
    private readonly notices: Notices,
    private readonly wishes: PictureWishes,
    private readonly decode: Decode,
    private readonly openVideo: OpenVideo,
    private readonly answers: PictureAnswers,
    private readonly now_ms: () => number,
  ) {}

  watch(watched: WatchedRun): void {
    const { answers } = this;
    const decoder = new PictureDecoder(this.decode, this.openVideo, {
      done: (name, picture) => {
        // One that nobody wants any more would be kept until the run is left.
        if (!this.wishes.has(watched.id, name)) {
          picture.bitmap.close();
          return;
        }
        watched.pictures.get(name)?.bitmap.close();
        watched.pictures.set(name, picture);
        watched.refusals.delete(streamOf(name));
        this.store.change('pictures');
      },
      settled: (streamId, sequence) => answers.settled(streamId, sequence),
      failed: (text) => this.notices.error(text),
      lost: (streamId) => answers.lost(streamId),
      videoFailed: () => answers.videoFailed(),
    });
    this.decoders.set(watched.id, decoder);
  }

  leave(watched: WatchedRun): void {
    this.decoders.get(watched.id)?.clear();
    this.decoders.delete(watched.id);
    for (const { bitmap } of watched.pictures.values()) bitmap.close();
  }

  /** A new connection: what the last one has sent is not continued. */
  clear(): void {
    for (const decoder of this.decoders.values()) decoder.clear();
    // The server reports again what it cannot draw.
    for (const { refusals } of this.store.state.watched) refusals.clear();
  }

  take(run: string, name: string, picture: PictureMessage): void {
    const decoder = this.decoders.get(run);
    if (decoder === undefined) {
      this.answers.settled(picture.streamId, picture.sequence);
      return;
    }
    const { data, encoding } = picture;
    const watched = this.store.state.watchedRun(run);
    watched?.meter.count(name, data.byteLength, encoding, this.now_ms());
    decoder.push(name, picture);
  }

  /** An error of the server; if it is about a picture, the run keeps it until that picture comes. */
  refuse({ run, picture, message }: ServerMessage & { type: 'error' }): void {
    this.notices.error(message);
    if (run === undefined || picture === undefined) return;
    this.store.state.watchedRun(run)?.refusals.set(picture, message);
    this.store.change('pictures');
  }
}

/** The stream's name in the name under which its pictures arrive (picturesOf). */
function streamOf(name: string): string {
  return name.replace(/\?.*$/, '');
}
