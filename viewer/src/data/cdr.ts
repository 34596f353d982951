/** Reads values from CDR (XCDR1, little endian), as ROS 2 writes messages. Throws RangeError where the bytes end too early. */
export class Cdr {
  private readonly view: DataView;
  private at = 4;

  constructor(private readonly bytes: Uint8Array) {
    if (bytes.length < 4 || bytes[1] !== 1) throw new RangeError("no little-endian CDR");
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  private take(size: number, align = size): number {
    const begin = 4 + Math.ceil((this.at - 4) / align) * align;
    if (begin + size > this.bytes.length) throw new RangeError("the message ends too early");
    this.at = begin + size;
    return begin;
  }

  u8(): number {
    return this.view.getUint8(this.take(1));
  }
  i32(): number {
    return this.view.getInt32(this.take(4), true);
  }
  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }
  f32(): number {
    return this.view.getFloat32(this.take(4), true);
  }
  f64(): number {
    return this.view.getFloat64(this.take(8), true);
  }
  text(): string {
    const length = this.u32();
    const begin = this.take(length, 1);
    return new TextDecoder().decode(this.bytes.subarray(begin, begin + Math.max(0, length - 1)));
  }
  /** Reads how many things follow, each of at least `size` bytes: no more than there can be. */
  count(size: number): number {
    const count = this.u32();
    if (count * size > this.bytes.length - this.at) throw new RangeError("the message ends too early");
    return count;
  }
  f32s(): Float32Array {
    return Float32Array.from({ length: this.count(4) }, () => this.f32());
  }
  f64s(): Float64Array {
    return Float64Array.from({ length: this.count(8) }, () => this.f64());
  }
  i8s(): Int8Array {
    const count = this.count(1);
    const begin = this.take(count, 1);
    return new Int8Array(this.bytes.buffer, this.bytes.byteOffset + begin, count);
  }
}
