// VP8 by the browser's WebCodecs, behind an interface that tests can replace.
import type { PictureMessage } from '../../protocol/parse';

/** One stream's decoder. Every picture but a key picture needs the one before. */
export interface VideoDecoding {
  decode(message: PictureMessage): void;
  close(): void;
  /** Pictures that wait to be decoded. */
  readonly waiting: number;
}

export interface VideoEvents {
  /** @param sequence  of the message */
  decoded(sequence: number, frame: VideoFrame): void;
  /** The decoder is of no use any more. */
  failed(): void;
}

export type OpenVideo = (events: VideoEvents) => VideoDecoding;

/** VP8 does not tell them: the server encodes with the full range (server/views/video). */
const kConfig: VideoDecoderConfig = {
  codec: 'vp8',
  optimizeForLatency: true,
  colorSpace: { fullRange: true, matrix: 'smpte170m', primaries: 'bt709', transfer: 'bt709' },
};

export const openVideo: OpenVideo = (events) => {
  const decoder = new VideoDecoder({
    output: (frame) => events.decoded(frame.timestamp, frame),
    error: () => events.failed(),
  });
  decoder.configure(kConfig);
  return {
    decode({ key, sequence, data }) {
      const type = key ? 'key' : 'delta';
      decoder.decode(new EncodedVideoChunk({ type, timestamp: sequence, data }));
    },
    close() {
      if (decoder.state !== 'closed') decoder.close();
    },
    get waiting() {
      return decoder.decodeQueueSize;
    },
  };
};

/** A VP8 key picture of 256 x 64 px, whose grey level grows from 0 to 255 to the right. */
const kRamp =
  'kA0AnQEqAAFAAAAHCIWFiJmEiAAoF3IoC2ApH8Ap/9gd8N+/+2A/QX3/qcsXoHJTaVnL/41WcJGNVM0D7WJOXRbW4srp' +
  'knZKrIrmQwvzUBmsBMPixJyr9x0NMufXirkRj0s/87Zplz68VciMeln/nbNMufXNAP7/to///dzD/zTb/7ICC4CZGEf5' +
  'kbrLxaIB7Tx3nmDDSVawVPIv67nkHROt2ewRaBgtCF3eELu8IXd4Qu7whd3hC7vCFwAA';
const kRampSize = { width: 256, height: 64 };
const kWrongBy = 3;

/**
 * Whether the browser decodes VP8 and shows the right grey levels: not every browser has WebCodecs,
 * those that have it offer it only to secure contexts (https or localhost), and not every one regards
 * the colour space.
 */
export async function videoWorks(): Promise<boolean> {
  if (typeof VideoDecoder === 'undefined' || typeof OffscreenCanvas === 'undefined') return false;
  try {
    const { supported } = await VideoDecoder.isConfigSupported(kConfig);
    return supported === true && (await showsRamp());
  } catch {
    return false;
  }
}

function showsRamp(): Promise<boolean> {
  const data = Uint8Array.from(atob(kRamp), (letter) => letter.charCodeAt(0));
  return new Promise((resolve) => {
    const decoder = new VideoDecoder({
      output: (frame) => {
        const { width, height } = kRampSize;
        const context = new OffscreenCanvas(width, height).getContext('2d');
        context?.drawImage(frame, 0, 0);
        frame.close();
        const pixels = context?.getImageData(0, height / 2, width, 1).data;
        const right = (level: number) => Math.abs((pixels?.[4 * level] ?? -99) - level) <= kWrongBy;
        resolve([0, 8, 64, 128, 200, 247, 255].every(right));
        decoder.close();
      },
      error: () => resolve(false),
    });
    decoder.configure(kConfig);
    decoder.decode(new EncodedVideoChunk({ type: 'key', timestamp: 0, data }));
    decoder.flush().catch(() => resolve(false));
  });
}
