// Which pictures the panels on the screen need; the others are not subscribed.
import { picturesOf } from '../../connection/stream_client';
import type { PictureStream } from '../../protocol/messages';

export class PictureWishes {
  private readonly wishes = new Map<string, readonly PictureStream[]>();

  /** Replaces the wishes of a panel; none when it is hidden. */
  set(panel: string, streams: readonly PictureStream[]): void {
    if (streams.length === 0) this.wishes.delete(panel);
    else this.wishes.set(panel, streams);
  }

  /** Whether a panel needs these pictures. @param name  under which they arrive */
  has(run: string, name: string): boolean {
    return [...this.wishes.values()]
      .flat()
      .some((one) => one.run === run && picturesOf(one.name, one.camera, one.view) === name);
  }

  /** Each stream once, as large and as often as any panel wants it. */
  union(): PictureStream[] {
    const streams = new Map<string, PictureStream>();
    for (const stream of [...this.wishes.values()].flat()) {
      const key = JSON.stringify([stream.run, stream.name, stream.camera, stream.view]);
      const known = streams.get(key);
      streams.set(key, known === undefined ? stream : greater(known, stream));
    }
    return [...streams.values()];
  }
}

function greater(a: PictureStream, b: PictureStream): PictureStream {
  const most = (x: number | undefined, y: number | undefined) =>
    x === undefined || y === undefined ? (x ?? y) : Math.max(x, y);
  const limits = {
    max_hz: most(a.max_hz, b.max_hz),
    quality: most(a.quality, b.quality),
    max_width_px: most(a.max_width_px, b.max_width_px),
  };
  const known = Object.entries(limits).filter(([, value]) => value !== undefined);
  return { ...a, ...(Object.fromEntries(known) as Partial<typeof limits>) } as PictureStream;
}
