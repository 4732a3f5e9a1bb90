import type { PictureHeader } from '../../src/protocol/parse';

const kHeaderBytes = 60;

/** A header with the given changes. */
export function sampleHeader(change: Partial<PictureHeader> = {}): PictureHeader {
  return {
    streamId: 1,
    sequence: 0,
    frame: 0,
    t_ns: 0,
    width_px: 4,
    height_px: 3,
    encoding: 'jpeg',
    key: false,
    live: false,
    scale: null,
    fullWidth_px: 4,
    fullHeight_px: 3,
    ...change,
  };
}

/** A picture as the server sends it: the inverse of parsePicture. */
export function encodePicture(header: PictureHeader, payload: Uint8Array): ArrayBuffer {
  const buffer = new ArrayBuffer(kHeaderBytes + payload.byteLength);
  const view = new DataView(buffer);
  view.setUint32(0, 0x4c46564f, true);
  view.setUint16(4, 2, true);
  view.setUint16(6, 1, true);
  view.setUint32(8, header.streamId, true);
  view.setUint32(12, header.sequence, true);
  view.setBigInt64(16, BigInt(header.frame), true);
  view.setBigInt64(24, BigInt(header.t_ns), true);
  view.setUint16(32, header.width_px, true);
  view.setUint16(34, header.height_px, true);
  view.setUint16(36, header.encoding === 'vp8' ? 3 : 1, true);
  view.setUint16(38, kHeaderBytes, true);
  view.setUint32(40, payload.byteLength, true);
  const { scale } = header;
  const scaleFlags = scale === null ? 0 : scale.logarithmic ? 6 : 2;
  view.setUint32(44, (header.live ? 1 : 0) | scaleFlags | (header.key ? 8 : 0), true);
  view.setFloat32(48, scale?.low ?? 0, true);
  view.setFloat32(52, scale?.high ?? 0, true);
  view.setUint16(56, header.fullWidth_px, true);
  view.setUint16(58, header.fullHeight_px, true);
  new Uint8Array(buffer, kHeaderBytes).set(payload);
  return buffer;
}
