// A DataFlash log made by hand.

function record(type, length, fill) {
  const bytes = Buffer.alloc(length);
  bytes.set([0xa3, 0x95, type]);
  fill?.(bytes);
  return bytes;
}

function format(type, length, name, letters, columns) {
  return record(0x80, 89, (bytes) => {
    bytes.set([type, length], 3);
    bytes.write(name, 5, 4, 'latin1');
    bytes.write(letters, 9, 16, 'latin1');
    bytes.write(columns, 25, 64, 'latin1');
  });
}

function modeAt(t_s, mode) {
  return record(3, 14, (bytes) => {
    bytes.writeBigUInt64LE(BigInt(Math.round(t_s * 1e6)), 3);
    bytes.set([mode, mode, 1], 11);
  });
}

function messageAt(t_s, text) {
  return record(4, 75, (bytes) => {
    bytes.writeBigUInt64LE(BigInt(Math.round(t_s * 1e6)), 3);
    bytes.write(text, 11, 64, 'latin1');
  });
}

/**
 * Flies a circle of 200 m radius with 20 m/s at 25 Hz, beginning at 1 s: MANUAL, then AUTO, and RTL for
 * the last tenth. The height is that of a slow climb.
 *
 * @param outlierAt_s one position at this time is 0.001 deg, 111 m, north of its place
 */
export function dataflashFlight(duration_s, outlierAt_s = null) {
  const pieces = [
    format(0x80, 89, 'FMT', 'BBnNZ', 'Type,Length,Name,Format,Columns'),
    format(2, 29, 'SIM', 'QLLfccc', 'TimeUS,Lat,Lng,Alt,Roll,Pitch,Yaw'),
    format(3, 14, 'MODE', 'QMBB', 'TimeUS,Mode,ModeNum,Rsn'),
    format(4, 75, 'MSG', 'QZ', 'TimeUS,Message'),
    messageAt(1, 'ArduPlane V4.5.0'),
    modeAt(1, 0),
  ];
  const metresPerDeg = 111_195;
  for (let i = 0; i < duration_s * 25; i += 1) {
    const t_s = 1 + i / 25;
    if (i === 25) pieces.push(modeAt(t_s, 10));
    if (i === Math.round(duration_s * 22.5)) pieces.push(modeAt(t_s, 11));
    const angle = (20 / 200) * (t_s - 1);
    const north_m = 200 * Math.sin(angle);
    const east_m = 200 * (1 - Math.cos(angle));
    pieces.push(
      record(2, 29, (bytes) => {
        bytes.writeBigUInt64LE(BigInt(Math.round(t_s * 1e6)), 3);
        const wrong_deg = outlierAt_s !== null && i === Math.round((outlierAt_s - 1) * 25) ? 1e-3 : 0;
        bytes.writeInt32LE(Math.round((47 + north_m / metresPerDeg + wrong_deg) * 1e7), 11);
        const east_deg = east_m / (metresPerDeg * Math.cos((47 * Math.PI) / 180));
        bytes.writeInt32LE(Math.round((8 + east_deg) * 1e7), 15);
        bytes.writeFloatLE(500 + 0.5 * (t_s - 1), 19);
        bytes.writeInt16LE(1150, 23);
        bytes.writeInt16LE(150, 25);
        const yaw_deg = (angle * 180) / Math.PI;
        bytes.writeInt16LE(Math.round((((yaw_deg + 180) % 360) - 180) * 100), 27);
      }),
    );
  }
  return Buffer.concat(pieces);
}
