/** One message of a trace. `bytes` points into the file. */
export interface Message {
  topic: string;
  schema: string;
  encoding: string;
  /** Seconds. */
  time: number;
  bytes: Uint8Array;
}

const MAGIC = [0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a];
const SCHEMA = 3, CHANNEL = 4, MESSAGE = 5, CHUNK = 6;

function text(view: DataView, at: number): [string, number] {
  const length = view.getUint32(at, true);
  const bytes = new Uint8Array(view.buffer, view.byteOffset + at + 4, length);
  return [new TextDecoder().decode(bytes), at + 4 + length];
}

/**
 * Calls `visit` for each message of an MCAP file (version 0) in the order of the file. Returns what is wrong with it, in words: what
 * comes before was visited; null if all is well. Chunks must not be compressed: Rondo's are not.
 */
export function forEachMessage(file: Uint8Array, visit: (message: Message) => void): string | null {
  if (file.length < MAGIC.length || MAGIC.some((byte, i) => file[i] !== byte)) return "this is no MCAP file";
  const schemas = new Map<number, string>();
  const channels = new Map<number, { schema: string; topic: string; encoding: string }>();
  const records = (bytes: Uint8Array, begin: number): string | null => {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    for (let at = begin; at < bytes.length; ) {
      if (bytes.length - at === MAGIC.length && MAGIC.every((byte, i) => bytes[at + i] === byte)) return null;
      if (at + 9 > bytes.length) return "the file ends in the middle of a record";
      const kind = view.getUint8(at);
      const size = Number(view.getBigUint64(at + 1, true));
      const body = at + 9;
      if (body + size > bytes.length) return "the file ends in the middle of a record";
      if (kind === SCHEMA) {
        schemas.set(view.getUint16(body, true), text(view, body + 2)[0]);
      } else if (kind === CHANNEL) {
        const [topic, next] = text(view, body + 4);
        const schema = schemas.get(view.getUint16(body + 2, true)) ?? "";
        channels.set(view.getUint16(body, true), { schema, topic, encoding: text(view, next)[0] });
      } else if (kind === MESSAGE) {
        const channel = channels.get(view.getUint16(body, true));
        if (channel !== undefined)
          visit({ ...channel, time: Number(view.getBigUint64(body + 6, true)) * 1e-9, bytes: bytes.subarray(body + 22, body + size) });
      } else if (kind === CHUNK) {
        const [compression, next] = text(view, body + 28);
        if (compression !== "") return `chunks are compressed (${compression}), which this page does not read`;
        const length = Number(view.getBigUint64(next, true));
        if (next + 8 + length > body + size) return "a chunk is longer than its record";
        const wrong = records(bytes.subarray(next + 8, next + 8 + length), 0);
        if (wrong !== null) return wrong;
      }
      at = body + size;
    }
    return begin === 0 ? null : "the file has no end: whoever wrote it was ended";
  };
  try {
    return records(file, MAGIC.length);
  } catch (error) {
    if (error instanceof RangeError) return "a record is damaged";
    throw error;
  }
}
