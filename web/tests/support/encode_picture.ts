import type { PictureHeader } from '../../src/protocol/parse';

const kHeaderBytes = 48;

/** A picture as the server sends it: the inverse of parsePicture. */
export function encodePicture(header: PictureHeader, jpeg: Uint8Array): ArrayBuffer {
  const buffer = new ArrayBuffer(kHeaderBytes + jpeg.byteLength);
  const view = new DataView(buffer);
  view.setUint32(0, 0x4c46564f, true);
  view.setUint16(4, 1, true);
  view.setUint16(6, 1, true);
  view.setUint32(8, header.streamId, true);
  view.setUint32(12, header.sequence, true);
  view.setBigInt64(16, BigInt(header.frame), true);
  view.setBigInt64(24, BigInt(header.t_ns), true);
  view.setUint16(32, header.width_px, true);
  view.setUint16(34, header.height_px, true);
  view.setUint16(36, header.grey ? 1 : 2, true);
  view.setUint16(38, kHeaderBytes, true);
  view.setUint32(40, jpeg.byteLength, true);
  view.setUint32(44, header.live ? 1 : 0, true);
  new Uint8Array(buffer, kHeaderBytes).set(jpeg);
  return buffer;
}
