// Pure parsers of received messages. They throw only ParseError.
import type { SceneLabel, ServerMessage } from './messages';

export class ParseError extends Error {}

const kRequired: Record<ServerMessage['type'], Record<string, string>> = {
  hello: { protocol: 'number', server: 'string' },
  ok: {},
  error: { code: 'string', message: 'string' },
  run: { run: 'object' },
  series: { run: 'string', series: 'object' },
  pictures: { pictures: 'object' },
  labels: { id: 'number', sequence: 'number', labels: 'object' },
  rows: { run: 'string', stream: 'string', seq: 'number', columns: 'object' },
  estimators: { run: 'string', estimators: 'object' },
  metrics: { run: 'string', metrics: 'object' },
  playback: { t_ns: 'number', playing: 'boolean', runs: 'object' },
};

/** @return null for a type unknown to this version, since newer servers may send more types. */
export function parseServerMessage(text: string): ServerMessage | null {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    throw new ParseError('message is not JSON');
  }
  if (typeof value !== 'object' || value === null) throw new ParseError('message is not an object');
  const message = value as Record<string, unknown>;
  const type = message['type'];
  if (typeof type !== 'string') throw new ParseError('message has no type');
  if (!Object.hasOwn(kRequired, type)) return null;
  for (const [field, kind] of Object.entries(kRequired[type as ServerMessage['type']])) {
    if (typeof message[field] !== kind || message[field] === null) {
      throw new ParseError(`message ${type}: field ${field} is not of type ${kind}`);
    }
  }
  return message as unknown as ServerMessage;
}

export type PictureEncoding = 'jpeg' | 'vp8';

export interface PictureHeader {
  streamId: number;
  sequence: number;
  frame: number;
  t_ns: number;
  width_px: number;
  height_px: number;
  encoding: PictureEncoding;
  /** Does not need the video picture before. */
  key: boolean;
  live: boolean;
  /** Of depth [m] and error pictures [grey levels]: the values at the ends of their colours. */
  scale: { low: number; high: number; logarithmic: boolean } | null;
  /** Of the image before it was reduced. */
  fullWidth_px: number;
  fullHeight_px: number;
}

export interface PictureMessage extends PictureHeader {
  /** Of a scene. */
  labels?: readonly SceneLabel[];
  /** A view into the message, not a copy. */
  data: Uint8Array<ArrayBuffer>;
}

const kPictureHeaderBytes = 60;
const kPictureVersion = 2;
const kMagic = 0x4c46564f;
const kPictureType = 1;
/** JPEG grey, JPEG colour, VP8. */
const kEncodings: Readonly<Record<number, PictureEncoding>> = { 1: 'jpeg', 2: 'jpeg', 3: 'vp8' };
const kFlagLive = 1;
const kFlagScale = 2;
const kFlagLogarithmic = 4;
const kFlagKey = 8;

/**
 * Parses a binary message.
 * @return null for a message type unknown to this version.
 */
export function parsePicture(buffer: ArrayBuffer): PictureMessage | null {
  if (buffer.byteLength < kPictureHeaderBytes) {
    throw new ParseError(`picture of ${buffer.byteLength} bytes is shorter than its header`);
  }
  const view = new DataView(buffer);
  if (view.getUint32(0, true) !== kMagic) throw new ParseError('picture has no OVFL magic');
  const version = view.getUint16(4, true);
  if (version !== kPictureVersion) {
    throw new ParseError(`picture version ${version} is not ${kPictureVersion}`);
  }
  if (view.getUint16(6, true) !== kPictureType) return null;
  const encoding = kEncodings[view.getUint16(36, true)];
  if (encoding === undefined) {
    throw new ParseError(`picture encoding ${view.getUint16(36, true)} is unknown`);
  }
  const headerBytes = view.getUint16(38, true);
  const payloadBytes = view.getUint32(40, true);
  if (headerBytes < kPictureHeaderBytes || headerBytes + payloadBytes > buffer.byteLength) {
    throw new ParseError(
      `picture says ${headerBytes} + ${payloadBytes} bytes, has ${buffer.byteLength}`,
    );
  }
  const flags = view.getUint32(44, true);
  return {
    streamId: view.getUint32(8, true),
    sequence: view.getUint32(12, true),
    frame: Number(view.getBigInt64(16, true)),
    t_ns: Number(view.getBigInt64(24, true)),
    width_px: view.getUint16(32, true),
    height_px: view.getUint16(34, true),
    encoding,
    key: (flags & kFlagKey) !== 0,
    live: (flags & kFlagLive) !== 0,
    scale:
      (flags & kFlagScale) === 0
        ? null
        : {
            low: view.getFloat32(48, true),
            high: view.getFloat32(52, true),
            logarithmic: (flags & kFlagLogarithmic) !== 0,
          },
    fullWidth_px: view.getUint16(56, true),
    fullHeight_px: view.getUint16(58, true),
    data: new Uint8Array(buffer, headerBytes, payloadBytes),
  };
}
