// Reads CBOR (RFC 8949) as serde writes it: of definite lengths, with texts or numbers as keys. Byte strings stay views of what was received.

export function decode(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const text = new TextDecoder();
  let at = 0;

  function length(kind) {
    if (kind < 24) return kind;
    const from = at;
    switch (kind) {
      case 24: at += 1; return view.getUint8(from);
      case 25: at += 2; return view.getUint16(from);
      case 26: at += 4; return view.getUint32(from);
      case 27: at += 8; return Number(view.getBigUint64(from));
      default: throw new Error(`CBOR of an indefinite length at byte ${from}`);
    }
  }

  function taken(count) {
    at += count;
    return bytes.subarray(at - count, at);
  }

  function simple(kind) {
    const from = at;
    switch (kind) {
      case 20: return false;
      case 21: return true;
      case 22: return null;
      case 25: at += 2; return half(view.getUint16(from));
      case 26: at += 4; return view.getFloat32(from);
      case 27: at += 8; return view.getFloat64(from);
      default: throw new Error(`CBOR has no simple value ${kind} here, at byte ${from}`);
    }
  }

  function item() {
    const head = view.getUint8(at++);
    const kind = head & 31;
    switch (head >> 5) {
      case 0: return length(kind);
      case 1: return -1 - length(kind);
      case 2: return taken(length(kind));
      case 3: return text.decode(taken(length(kind)));
      case 4: return Array.from({ length: length(kind) }, item);
      case 5: {
        const map = {};
        for (let left = length(kind); left > 0; left--) {
          const key = item();
          map[key] = item();
        }
        return map;
      }
      case 6: throw new Error(`CBOR with a tag at byte ${at - 1}`);
      default: return simple(kind);
    }
  }

  return item();
}

// A number of 16 bits: a sign, five bits of exponent, ten of fraction.
function half(bits) {
  const sign = bits & 0x8000 ? -1 : 1;
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  if (exponent === 0) return sign * fraction * 2 ** -24;
  if (exponent === 31) return fraction ? NaN : sign * Infinity;
  return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}
