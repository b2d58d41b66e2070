/** Reading a PGM image, enough for a preview; the server reads it with suspicion. Pure. */
export interface Grey {
  readonly width: number;
  readonly height: number;
  /** 0 black to 255 white, from the top row on. */
  readonly pixels: Uint8Array;
}

const MOST_PIXELS = 4096 * 4096;

/** The words of the header (magic, width, height, maxval) and where the pixels begin; comments are skipped. */
function readHeader(bytes: Uint8Array): { words: string[]; end: number } {
  const words: string[] = [];
  let at = 0;
  while (words.length < 4 && at < bytes.length) {
    const letter = String.fromCharCode(bytes[at] ?? 0);
    if (letter === "#") while (at < bytes.length && bytes[at] !== 10) at += 1;
    else if (/\s/.test(letter)) at += 1;
    else {
      let word = "";
      while (at < bytes.length && !/\s/.test(String.fromCharCode(bytes[at] ?? 32))) {
        word += String.fromCharCode(bytes[at] ?? 0);
        at += 1;
      }
      words.push(word);
    }
  }
  return { words, end: at + 1 };
}

function plainPixels(bytes: Uint8Array, from: number): number[] {
  const text = new TextDecoder("latin1").decode(bytes.subarray(from));
  return text.replace(/#.*/g, "").trim().split(/\s+/).map(Number);
}

/** The image, or null when it is not a PGM that can be shown. */
export function readPgm(bytes: Uint8Array): Grey | null {
  const { words, end } = readHeader(bytes);
  const [magic, ...numbers] = words;
  const [width = 0, height = 0, most = 0] = numbers.map(Number);
  const size = width * height;
  if ((magic !== "P5" && magic !== "P2") || !(size > 0 && size <= MOST_PIXELS) || !(most > 0 && most <= 65535))
    return null;
  const wide = most > 255 ? 2 : 1;
  const plain = magic === "P2" ? plainPixels(bytes, end) : null;
  const value = (index: number) => {
    if (plain) return plain[index] ?? 0;
    const at = end + index * wide;
    return wide === 2 ? (bytes[at] ?? 0) * 256 + (bytes[at + 1] ?? 0) : (bytes[at] ?? 0);
  };
  if (!plain && bytes.length < end + size * wide) return null;
  return {
    width,
    height,
    pixels: Uint8Array.from({ length: size }, (_, index) => Math.round((value(index) / most) * 255)),
  };
}
