// Watches a run with the Foxglove protocol's own client and prints one line of JSON for each thing
// it is told. Messages are decoded after the definitions that the server advertised. It plays the
// run at several times its speed, and ends with its end.
const { FoxgloveClient } = require("@foxglove/ws-protocol");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const { WebSocket } = require("ws");

const [url, speed] = process.argv.slice(2);
const print = (line) => console.log(JSON.stringify(line, (_, entry) =>
  typeof entry === "bigint" || (typeof entry === "number" && !Number.isFinite(entry))
    ? String(entry) : entry));
const xyz = (v) => [v.x, v.y, v.z];
const xyzw = (q) => [q.x, q.y, q.z, q.w];

const socket = new WebSocket(url, [FoxgloveClient.SUPPORTED_SUBPROTOCOL]);
const client = new FoxgloveClient({ ws: socket });
const channels = new Map(); // by subscription
let playing = false;

/// What a test compares of a message.
function summary(message) {
  const line = {};
  const header = message.header ?? message.transforms?.[0].header ?? message;
  line.stamp = [header.stamp.sec, header.stamp.nanosec ?? header.stamp.nsec];
  line.frame_id = header.frame_id;
  if (message.pose) Object.assign(line, { p: xyz(message.pose.position), q: xyzw(message.pose.orientation) });
  if (message.transforms) {
    const { child_frame_id: child, transform } = message.transforms[0];
    Object.assign(line, { child, p: xyz(transform.translation), q: xyzw(transform.rotation) });
  }
  if (message.poses) line.poses = message.poses.map((entry) => xyz(entry.pose.position));
  if (message.format) {
    Object.assign(line, { format: message.format, bytes: message.data.length,
      begins: Array.from(message.data.slice(0, 3)) });
  }
  if (message.distortion_model) {
    Object.assign(line, { model: message.distortion_model, k: Array.from(message.k),
      size: [message.width, message.height] });
  }
  if (message.latitude !== undefined) line.place = [message.latitude, message.longitude, message.altitude];
  if (message.msg !== undefined) Object.assign(line, { level: message.level, name: message.name, text: message.msg });
  if (message.state !== undefined) Object.assign(line, { state: message.state, error_m: message.error_m });
  if (message.point_step) {
    Object.assign(line, { points: message.width, step: message.point_step,
      fields: message.fields.map((field) => field.name) });
  }
  return line;
}

client.on("error", (error) => print({ error: error.message }));
client.on("close", () => process.exit(0));
client.on("serverInfo", (info) => print({ info }));
client.on("status", (status) => print({ status }));
client.on("time", ({ timestamp }) => print({ time: timestamp }));
client.on("advertise", (list) => {
  print({ advertised: list.map(({ topic, encoding, schemaName }) => [topic, encoding, schemaName]) });
  for (const channel of list) {
    const reader = new MessageReader(parse(channel.schema, { ros2: true }));
    channels.set(client.subscribe(channel.id), { topic: channel.topic, reader });
  }
  client.subscribeParameterUpdates([]);
  client.setParameters([{ name: "speed", value: Number(speed) }], "speed");
});
client.on("message", ({ subscriptionId, timestamp, data }) => {
  const { topic, reader } = channels.get(subscriptionId);
  print({ topic, log_ns: timestamp, ...summary(reader.readMessage(data)) });
});
client.on("parameterValues", ({ parameters, id }) => {
  print({ parameters, id });
  const now = parameters.find(({ name }) => name === "playing");
  if (now === undefined) return;
  if (playing && !now.value) setTimeout(() => client.close(), 500);
  playing = now.value;
});
setTimeout(() => { print({ error: "the run did not end" }); process.exit(1); }, 25000);
