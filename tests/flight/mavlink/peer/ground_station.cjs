// A ground station (node-mavlink) that uploads a mission to a vehicle, arms it, starts it and watches.
//   node ground_station.cjs PORT     prints one line of each step
const net = require('node:net');
const {
  minimal,
  standard,
  common,
  ardupilotmega,
  MavLinkPacketParser,
  MavLinkPacketSplitter,
  MavLinkProtocolV2,
  send,
} = require('node-mavlink');

const registry = {
  ...minimal.REGISTRY,
  ...standard.REGISTRY,
  ...common.REGISTRY,
  ...ardupilotmega.REGISTRY,
};
const protocol = new MavLinkProtocolV2(255, 190);
const socket = net.connect(Number(process.argv[2]), '127.0.0.1');
const tell = (message) => send(socket, message, protocol);
const fill = (message, fields) => Object.assign(message, { targetSystem: 1, targetComponent: 1 }, fields);

const mission = [
  { command: 16, frame: 0, x: 393553750, y: -860307280, z: 227.7 },
  { command: 22, frame: 3, x: 393526750, y: -860307280, z: 60, param1: 15 },
  { command: 16, frame: 3, x: 393463650, y: -860307280, z: 120 },
  { command: 20, frame: 3, x: 0, y: 0, z: 0 },
];
const parameters = new Set();
let step = 'heartbeat';
let modes = [];

function command(id, params) {
  const fields = { command: id, confirmation: 0 };
  params.forEach((value, i) => { fields[`_param${i + 1}`] = value; });
  return tell(fill(new common.CommandLong(), fields));
}

async function take(name, data) {
  if (name === 'HEARTBEAT' && step === 'heartbeat') {
    console.log(`heartbeat type=${data.type} autopilot=${data.autopilot}`);
    step = 'parameters';
    await tell(fill(new common.ParamRequestList(), {}));
  } else if (name === 'PARAM_VALUE' && step === 'parameters') {
    parameters.add(data.paramId);
    if (parameters.size < data.paramCount) return;
    console.log(`parameters ${parameters.size} roll_rate=${parameters.has('RLL2SRV_RMAX')}`);
    step = 'mission';
    await tell(fill(new common.MissionCount(), { count: mission.length, missionType: 0 }));
  } else if (name === 'MISSION_REQUEST_INT' && step === 'mission') {
    const item = mission[data.seq];
    await tell(fill(new common.MissionItemInt(), {
      seq: data.seq, param1: 0, param2: 0, param3: 0, param4: 0, current: 0, autocontinue: 1,
      missionType: 0, ...item,
    }));
  } else if (name === 'MISSION_ACK' && step === 'mission') {
    console.log(`mission ack=${data.type}`);
    step = 'arm';
    await command(400, [1, 0, 0, 0, 0, 0, 0]);
  } else if (name === 'COMMAND_ACK') {
    console.log(`command ${data.command} result=${data.result}`);
    if (data.command === 400) {
      step = 'start';
      await command(300, [0, 0, 0, 0, 0, 0, 0]);
    } else if (data.command === 300) {
      step = 'climb';
    }
  } else if (name === 'GLOBAL_POSITION_INT' && step === 'climb' && data.relativeAlt > 80000) {
    console.log(`climbed lat=${data.lat} lon=${data.lon}`);
    step = 'done';
  } else if (name === 'HEARTBEAT' && step === 'done') {
    console.log(`mode=${data.customMode} armed=${(data.baseMode & 0x80) !== 0}`);
    socket.end();
    process.exit(0);
  }
}

socket
  .pipe(new MavLinkPacketSplitter())
  .pipe(new MavLinkPacketParser())
  .on('data', (packet) => {
    const kind = registry[packet.header.msgid];
    if (kind) take(kind.MSG_NAME, packet.protocol.data(packet.payload, kind)).catch(fail);
  });
function fail(error) {
  console.log(`error ${error.message}`);
  process.exit(1);
}
socket.on('error', fail);
socket.on('connect', () => {
  const heartbeat = new minimal.Heartbeat();
  Object.assign(heartbeat, { type: 6, autopilot: 8, baseMode: 0, customMode: 0, systemStatus: 4 });
  tell(heartbeat).catch(fail);
});
setTimeout(() => fail(new Error(`nothing more after step ${step}`)), 60000);
