// An independent implementation of MAVLink at the other end (node-mavlink).
//   node peer.cjs read KEY FRAME...   prints one line of each frame, with whether its signature is right
//   node peer.cjs write KEY           prints frames
// KEY and FRAMEs are hexadecimal.
const { Readable } = require('node:stream');
const {
  minimal,
  standard,
  common,
  ardupilotmega,
  MavLinkPacketParser,
  MavLinkPacketSplitter,
  MavLinkProtocolV1,
  MavLinkProtocolV2,
} = require('node-mavlink');

const registry = {
  ...minimal.REGISTRY,
  ...standard.REGISTRY,
  ...common.REGISTRY,
  ...ardupilotmega.REGISTRY,
};
const [mode, keyText, ...frames] = process.argv.slice(2);
const key = Buffer.from(keyText, 'hex');
const hex = (buffer) => console.log(buffer.toString('hex'));

function show(packet) {
  const kind = registry[packet.header.msgid];
  const data = packet.protocol.data(packet.payload, kind);
  const fields = kind.FIELDS.map((field) => `${field.source}=${data[field.name]}`);
  const signature = packet.signature
    ? packet.signature.matches(key) ? 'signed' : 'forged'
    : 'unsigned';
  console.log([kind.MSG_NAME, `seq=${packet.header.seq}`, signature, ...fields].join(' '));
}

if (mode === 'read') {
  const bytes = Buffer.concat(frames.map((frame) => Buffer.from(frame, 'hex')));
  Readable.from([bytes])
    .pipe(new MavLinkPacketSplitter())
    .pipe(new MavLinkPacketParser())
    .on('data', show);
} else {
  const heartbeat = new minimal.Heartbeat();
  Object.assign(heartbeat, { type: 1, autopilot: 3, baseMode: 0x81, customMode: 10, systemStatus: 4 });
  hex(new MavLinkProtocolV1(7, 1).serialize(heartbeat, 200));
  const position = new common.GlobalPositionInt();
  Object.assign(position, {
    timeBootMs: 123456, lat: -353632620, lon: 1491652370, alt: 584000, relativeAlt: 300000,
    vx: 2500, vy: -100, vz: 7, hdg: 9000,
  });
  hex(new MavLinkProtocolV2(7, 1).serialize(position, 201));
  const sim = new common.SimState();
  Object.assign(sim, {
    q1: 1, q2: 0, q3: 0, q4: 0, alt: 600, vn: 25, ve: 1, vd: -2, lat: 0, lon: 0,
    latInt: -353632620, lonInt: 1491652370, zgyro: 0.25,
  });
  hex(new MavLinkProtocolV2(7, 1).serialize(sim, 202));
  const signing = new MavLinkProtocolV2(7, 1, MavLinkProtocolV2.IFLAG_SIGNED);
  hex(signing.sign(signing.serialize(heartbeat, 203), 3, key, Date.UTC(2026, 0, 1)));
}
