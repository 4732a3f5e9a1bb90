import { describe, expect, it } from 'vitest';
import { ParseError, parsePicture, parseServerMessage } from '../../src/protocol/parse';
import { encodePicture, sampleHeader } from '../support/encode_picture';

/** Byte by byte as docs/PROTOCOL.md says, without the code under test. */
function pictureBytes(): Uint8Array<ArrayBuffer> {
  return Uint8Array.from([
    ...[0x4f, 0x56, 0x46, 0x4c], // magic, little-endian 0x4C46564F
    ...[2, 0], // version
    ...[1, 0], // type: picture
    ...[7, 0, 0, 0], // stream id
    ...[0x39, 0x30, 0, 0], // sequence 12345
    ...[0x10, 0x27, 0, 0, 0, 0, 0, 0], // frame 10000
    ...[0x00, 0xe8, 0x76, 0x48, 0x17, 0, 0, 0], // 100 s
    ...[0x00, 0x05], // 1280
    ...[0xc0, 0x03], // 960
    ...[2, 0], // JPEG colour
    ...[60, 0], // header length
    ...[3, 0, 0, 0], // payload length
    ...[7, 0, 0, 0], // live, with a scale, logarithmic
    ...[0, 0, 0x48, 0x43], // 200
    ...[0, 0, 0xc8, 0x44], // 1600
    ...[0x00, 0x0a], // 2560 of the whole image
    ...[0x80, 0x07], // 1920
    ...[0xff, 0xd8, 0xff],
  ]);
}

describe('parsePicture', () => {
  it('reads every field of the documented layout', () => {
    expect(parsePicture(pictureBytes().buffer)).toEqual({
      streamId: 7,
      sequence: 12345,
      frame: 10000,
      t_ns: 100e9,
      width_px: 1280,
      height_px: 960,
      encoding: 'jpeg',
      key: false,
      live: true,
      scale: { low: 200, high: 1600, logarithmic: true },
      fullWidth_px: 2560,
      fullHeight_px: 1920,
      data: Uint8Array.from([0xff, 0xd8, 0xff]),
    });
  });

  it('reads what a video picture says of itself', () => {
    const bytes = pictureBytes();
    bytes[36] = 3;
    bytes[44] = 8;
    expect(parsePicture(bytes.buffer)).toMatchObject({ encoding: 'vp8', key: true, live: false });
    bytes[44] = 0;
    expect(parsePicture(bytes.buffer)).toMatchObject({ encoding: 'vp8', key: false });
  });

  it('honours a longer header of a later version of the same layout', () => {
    const bytes = new Uint8Array(pictureBytes().length + 8);
    bytes.set(pictureBytes().subarray(0, 60));
    bytes[38] = 68;
    bytes.set([1, 2, 3], 68);
    expect(parsePicture(bytes.buffer)?.data).toEqual(Uint8Array.from([1, 2, 3]));
  });

  it('leaves out message types that it does not know', () => {
    const bytes = pictureBytes();
    bytes[6] = 9;
    expect(parsePicture(bytes.buffer)).toBeNull();
  });

  it.each([
    ['a wrong magic', 0, 0],
    ['an unknown version', 4, 3],
    ['an unknown encoding', 36, 4],
    ['a header that is too short', 38, 48],
    ['a payload beyond the message', 40, 4],
  ])('refuses %s', (_, offset, value) => {
    const bytes = pictureBytes();
    bytes[offset] = value;
    expect(() => parsePicture(bytes.buffer)).toThrow(ParseError);
  });

  it('refuses every truncation', () => {
    const bytes = pictureBytes();
    for (let length = 0; length < bytes.length; length += 1) {
      expect(() => parsePicture(bytes.slice(0, length).buffer)).toThrow(ParseError);
    }
  });

  it('gives back what encodePicture wrote, negative times too', () => {
    const header = sampleHeader({ sequence: 2, frame: -3, t_ns: -4, width_px: 5, height_px: 6 });
    const data = Uint8Array.from([9, 8, 7]);
    expect(parsePicture(encodePicture(header, data))).toEqual({ ...header, data });
    const depth = { ...header, scale: { low: 200, high: 1500, logarithmic: true } };
    expect(parsePicture(encodePicture(depth, data))).toEqual({ ...depth, data });
  });
});

describe('parseServerMessage', () => {
  it('gives a message with all its fields', () => {
    const text =
      '{"type":"error","request":3,"code":"invalid_argument","message":"speed.value = 99"}';
    expect(parseServerMessage(text)).toEqual({
      type: 'error',
      request: 3,
      code: 'invalid_argument',
      message: 'speed.value = 99',
    });
  });

  it('leaves out types that it does not know', () => {
    expect(parseServerMessage('{"type":"weather"}')).toBeNull();
    expect(parseServerMessage('{"type":"toString"}')).toBeNull();
  });

  it.each([
    '',
    '{',
    '7',
    'null',
    '[]',
    '{}',
    '{"type":3}',
    '{"type":"hello"}',
    '{"type":"run","run":null}',
    '{"type":"rows","stream":"truth","seq":"0","columns":{}}',
    '{"type":"playback","t_ns":0}',
  ])('refuses %s', (text) => {
    expect(() => parseServerMessage(text)).toThrow(ParseError);
  });
});
