// Prints what the MCAP project's own reader finds in a file: one line of JSON for each message, and
// a last one of the summary. The messages are decoded after the definitions in the file.
const fs = require("fs");
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");

async function main(file) {
  const bytes = fs.readFileSync(file);
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) =>
      new Uint8Array(bytes.buffer, bytes.byteOffset + Number(offset), Number(length)),
  };
  const indexed = await McapIndexedReader.Initialize({ readable });
  const readers = new Map();
  let count = 0;
  for await (const message of indexed.readMessages({ validateCrcs: true })) {
    const channel = indexed.channelsById.get(message.channelId);
    const schema = indexed.schemasById.get(channel.schemaId);
    if (!readers.has(schema.id)) {
      const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
      readers.set(schema.id, new MessageReader(definition));
    }
    const value = readers.get(schema.id).readMessage(message.data);
    const header = value.header ?? value.transforms[0].header;
    const line = {
      topic: channel.topic,
      type: schema.name,
      log_ns: message.logTime.toString(),
      stamp: [header.stamp.sec, header.stamp.nanosec ?? header.stamp.nsec],
      frame_id: header.frame_id,
    };
    if (value.pose) {
      const p = value.pose.position;
      const q = value.pose.orientation;
      Object.assign(line, { p: [p.x, p.y, p.z], q: [q.x, q.y, q.z, q.w] });
    }
    if (value.transforms) {
      const t = value.transforms[0];
      Object.assign(line, { child: t.child_frame_id, p: [t.transform.translation.x,
        t.transform.translation.y, t.transform.translation.z] });
    }
    if (value.encoding) {
      Object.assign(line, { encoding: value.encoding, size: [value.width, value.height, value.step],
        sum: value.data.reduce((sum, byte) => sum + byte, 0), bytes: value.data.length });
    }
    if (value.distortion_model) {
      Object.assign(line, { model: value.distortion_model, d: Array.from(value.d),
        k: Array.from(value.k), p: Array.from(value.p) });
    }
    if (channel.topic.startsWith("/sensors/")) line.value = { ...value, header: undefined };
    console.log(JSON.stringify(line, (_, entry) =>
      typeof entry === "number" && !Number.isFinite(entry) ? String(entry)
        : ArrayBuffer.isView(entry) ? Array.from(entry) : entry));
    ++count;
  }
  // The same file from start to end: every record and checksum.
  const stream = new McapStreamReader({ validateCrcs: true });
  stream.append(bytes);
  let streamed = 0;
  for (let record; (record = stream.nextRecord()); ) streamed += record.type === "Message" ? 1 : 0;
  console.log(JSON.stringify({ profile: indexed.header.profile, indexed: count, streamed,
    ended: stream.done(), stated: Number(indexed.statistics.messageCount),
    chunks: indexed.chunkIndexes.length }));
}

main(process.argv[2]).catch((error) => {
  console.log(JSON.stringify({ error: String(error) }));
  process.exit(1);
});
