// The decoders against the reference reader (@mcap/core), on real and on damaged files: node data.test.js TRACE...
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { McapStreamReader } from "@mcap/core";
import { forEachMessage, type Message } from "../src/data/mcap.ts";
import { bodiesAt, last, mapAt, pathAt, poseAt, readRecording } from "../src/data/recording.ts";

/** What the reference reader sees; null if it refuses the file. */
function reference(file: Uint8Array): { topic: string; time: number; size: number }[] | null {
  const reader = new McapStreamReader();
  const channels = new Map<number, string>();
  const messages: { topic: string; time: number; size: number }[] = [];
  try {
    reader.append(file);
    for (let record = reader.nextRecord(); record !== undefined; record = reader.nextRecord()) {
      if (record.type === "Channel") channels.set(record.id, record.topic);
      if (record.type === "Message")
        messages.push({ topic: channels.get(record.channelId) ?? "", time: Number(record.logTime) * 1e-9, size: record.data.length });
    }
    return reader.done() ? messages : null;
  } catch {
    return null;
  }
}

function ours(file: Uint8Array): { messages: Message[]; wrong: string | null } {
  const messages: Message[] = [];
  return { wrong: forEachMessage(file, (message) => messages.push(message)), messages };
}

// The same numbers on every machine.
let seed = 1;
function random(below: number): number {
  seed = (seed * 1103515245 + 12345) % 2147483648;
  return seed % below;
}

function whole(file: Uint8Array): void {
  const { wrong, messages } = ours(file);
  assert.equal(wrong, null);
  assert.deepEqual(messages.map((m) => ({ topic: m.topic, time: m.time, size: m.bytes.length })), reference(file));
  const recording = readRecording("x", file);
  assert.deepEqual(recording.problems, []);
  assert.ok(recording.robots.length > 0 && recording.end > 0);
  for (const time of [-1, 0, recording.end / 3, recording.end, 2 * recording.end]) {
    bodiesAt(recording, time);
    mapAt(recording, time);
    for (const robot of recording.robots) {
      pathAt(robot, time);
      const pose = poseAt(robot, time);
      if (pose !== null) assert.ok(Math.abs(Math.hypot(...pose.rotation) - 1) < 1e-6 && pose.position.every(Number.isFinite));
    }
  }
}

// Whatever is in a file, the page says what is wrong with it and shows the rest.
function damaged(file: Uint8Array): void {
  for (let i = 0; i < 300; ++i) {
    const bad = Uint8Array.from(i % 3 === 0 ? file.subarray(0, random(file.length)) : file);
    for (let k = random(5); k > 0 && bad.length > 0; --k) bad[random(bad.length)]! ^= 1 << random(8);
    const recording = readRecording("x", bad);
    bodiesAt(recording, recording.end);
    mapAt(recording, recording.end);
    for (const robot of recording.robots) pathAt(robot, recording.end), poseAt(robot, recording.end);
  }
  assert.deepEqual(readRecording("x", new Uint8Array(0)).problems, ["this is no MCAP file"]);
}

assert.equal(last([1, 2, 2, 3], 2), 2);
assert.equal(last([1], 0), -1);
for (const path of process.argv.slice(2)) {
  const file = new Uint8Array(readFileSync(path));
  whole(file);
  damaged(file);
}
console.log("decoders agree");
