// Reads a trace with the reference reader of JavaScript, checksums included, as a stream and by its index: prints how many messages each
// topic has. Status 1 if they differ, or something is damaged.
//
//   node read_mcap.mjs MODULES TRACE
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import path from "node:path";

const require = createRequire(path.resolve(process.argv[2], "package.json"));
const { McapIndexedReader, McapStreamReader } = require("@mcap/core");
const bytes = readFileSync(process.argv[3]);

function streamed() {
  const counts = {}, topics = new Map();
  const reader = new McapStreamReader({ validateCrcs: true });
  reader.append(bytes);
  for (let record; (record = reader.nextRecord()); ) {
    if (record.type === "Channel") topics.set(record.id, record.topic);
    if (record.type === "Message") counts[topics.get(record.channelId)] = (counts[topics.get(record.channelId)] ?? 0) + 1;
  }
  if (!reader.done()) throw new Error("the file does not end as it should");
  return counts;
}

async function indexed() {
  const counts = {};
  const readable = {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  };
  const reader = await McapIndexedReader.Initialize({ readable });
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    const topic = reader.channelsById.get(message.channelId).topic;
    counts[topic] = (counts[topic] ?? 0) + 1;
  }
  return counts;
}

const sorted = (counts) => JSON.stringify(Object.fromEntries(Object.entries(counts).sort()));
try {
  const one = sorted(streamed()), other = sorted(await indexed());
  if (one !== other) throw new Error(`as a stream ${one}, by its index ${other}`);
  console.log(one);
} catch (problem) {
  console.error(problem.message);
  process.exitCode = 1;
}
