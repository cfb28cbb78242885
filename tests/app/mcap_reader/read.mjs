// Reads a recording of Relief with @mcap/core and @foxglove/rosmsg2-serialization, that is, with
// nothing of Relief's: node read.mjs FILE.mcap FOLDER. FOLDER is the same clip as `relief record`
// writes it: every depth picture, and every lossless colour picture, must have the same pixels.
import { open, readFile } from "node:fs/promises";
import { strict as assert } from "node:assert";
import { join } from "node:path";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { decompress as unzstd } from "fzstd";
import lz4 from "lz4js";
import { PNG } from "pngjs";

const [path, folder] = process.argv.slice(2);

const decompressHandlers = {
  zstd: (data, size) => unzstd(data, new Uint8Array(Number(size))),
  lz4: (data, size) => lz4.decompress(data, Number(size)),
};

async function openFile(name) {
  const file = await open(name, "r");
  const { size } = await file.stat();
  return {
    size: async () => BigInt(size),
    read: async (offset, length) => {
      const buffer = new Uint8Array(Number(length));
      await file.read(buffer, 0, Number(length), Number(offset));
      return buffer;
    },
  };
}

// RVL after Wilson's paper, nibble by nibble.
function unrvl(data) {
  const view = new DataView(data.buffer, data.byteOffset, data.byteLength);
  const pixels = view.getUint32(0, true) * view.getUint32(4, true);
  const out = new Uint16Array(pixels);
  let nibbleIndex = 0;
  const number = () => {
    let value = 0;
    for (let shift = 0; ; shift += 3) {
      const word = view.getUint32(8 + 4 * (nibbleIndex >> 3), true);
      const nibble = (word >>> (28 - 4 * (nibbleIndex & 7))) & 15;
      nibbleIndex++;
      value |= (nibble & 7) << shift;
      if ((nibble & 8) === 0) return value;
    }
  };
  let previous = 0;
  for (let at = 0; at < pixels; ) {
    at += number();
    for (let left = number(); left > 0; left--) {
      const zigzag = number();
      previous += (zigzag >> 1) ^ -(zigzag & 1);
      out[at++] = previous;
    }
  }
  return out;
}

function unpng(data, skipRescale) {
  return PNG.sync.read(Buffer.from(data), { skipRescale });
}

// Red of a 16-bit picture is its grey.
function greyOf(png) {
  const out = new Uint16Array(png.width * png.height);
  for (let i = 0; i < out.length; i++) out[i] = png.data[4 * i];
  return out;
}

async function list(name) {
  const text = await readFile(join(folder, name), "utf8");
  return text.split("\n").filter((line) => line !== "" && !line.startsWith("#"))
    .map((line) => line.split(" "));
}

const seconds = ({ sec, nsec, nanosec }) =>
  `${sec}.${String(nsec ?? nanosec).padStart(9, "0")}`;

const reader = await McapIndexedReader.Initialize({ readable: await openFile(path),
  decompressHandlers });
assert.equal(reader.header.profile, "ros2");
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  assert.equal(channel.messageEncoding, "cdr");
  assert.equal(schema.encoding, "ros2msg");
  const text = new TextDecoder().decode(schema.data);
  decoders.set(channel.id, new MessageReader(parse(text, { ros2: true })));
}

const depthList = await list("depth.txt");
const colorList = await list("rgb.txt");
const camera = JSON.parse(await readFile(join(folder, "camera.json"), "utf8"));
const counts = {};
let lossless = 0;

async function checkDepth(message) {
  assert.match(message.format, /^16UC1; compressedDepth (rvl|png)$/);
  const body = message.data.subarray(12);
  const got = message.format.endsWith("rvl") ? unrvl(body) : greyOf(unpng(body, true));
  const [time, name] = depthList[counts.depth - 1];
  assert.equal(seconds(message.header.stamp), time);
  assert.deepEqual(got, greyOf(unpng(await readFile(join(folder, name)), true)));
}

async function checkColor(message) {
  const [time, name] = colorList[counts.color - 1];
  assert.equal(seconds(message.header.stamp), time);
  if (message.data[0] === 0xff) {
    assert.equal(message.data[1], 0xd8); // JPEG
    return;
  }
  const want = unpng(await readFile(join(folder, name)));
  assert.deepEqual(unpng(message.data).data, want.data);
  lossless++;
}

function checkInfo(message, want) {
  assert.deepEqual([message.width, message.height], [want.width, want.height]);
  assert.deepEqual([...message.k], [want.fx, 0, want.cx, 0, want.fy, want.cy, 0, 0, 1]);
  assert.equal(message.p[5], want.fy);
  assert.deepEqual([...message.d].slice(0, want.distortion?.length ?? 0), want.distortion ?? []);
}

function checkTransform(message) {
  const t = message.transforms[0].transform.translation;
  assert.deepEqual([t.x, t.y, t.z], camera.depth_to_color.translation);
}

for await (const message of reader.readMessages({ validateCrcs: true })) {
  const { topic } = reader.channelsById.get(message.channelId);
  const value = decoders.get(message.channelId).readMessage(message.data);
  const kind = topic.endsWith("compressedDepth") ? "depth"
    : topic.endsWith("image_raw/compressed") ? "color" : topic;
  counts[kind] = (counts[kind] ?? 0) + 1;
  if (kind === "depth") await checkDepth(value);
  if (kind === "color") await checkColor(value);
  if (kind === "/relief/depth/camera_info") checkInfo(value, camera.depth);
  if (kind === "/relief/color/camera_info") checkInfo(value, camera.color);
  if (kind === "/tf_static") checkTransform(value);
}
assert.equal(counts.depth, depthList.length);
assert.equal(counts.color, colorList.length);
for (const topic of ["/relief/depth/camera_info", "/relief/color/camera_info", "/tf_static"]) {
  assert.equal(counts[topic], 1, topic);
}

// The statistics, and the metadata.
const total = Object.values(counts).reduce((a, b) => a + b, 0);
assert.equal(Number(reader.statistics.messageCount), total);
assert.equal(reader.statistics.chunkCount, reader.chunkIndexes.length);
const metadata = [];
for await (const record of reader.readMetadata({ name: "relief" })) metadata.push(record);
assert.equal(metadata.length, 1);
assert.equal(Number(metadata[0].metadata.get("units_per_metre")), camera.depth.units_per_metre);

// The same file from its beginning to its end, without the index.
const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(new Uint8Array(await readFile(path)));
let streamed = 0;
for (let record; (record = stream.nextRecord()); ) {
  streamed += record.type === "Message" ? 1 : 0;
}
assert.ok(stream.done());
assert.equal(streamed, total);
console.log(`${path}: ${counts.depth} depth and ${counts.color} colour pictures ` +
  `(${lossless} lossless), ${reader.chunkIndexes.length} chunks: as they should be`);
