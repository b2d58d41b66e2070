/** The pixels of a chosen picture. */
import { useEffect, useState } from "react";
import { pictureOf, type Picture } from "./picture";

const MOST_SIDE = 4096;

/** Decode a picture, made smaller where it has more pixels than a map may have cells; null when it cannot be read. */
async function decode(file: File): Promise<Picture | null> {
  const bitmap = await createImageBitmap(file).catch(() => null);
  if (!bitmap) return null;
  const scale = Math.min(1, MOST_SIDE / Math.max(bitmap.width, bitmap.height));
  const [width, height] = [bitmap.width, bitmap.height].map((side) => Math.max(1, Math.round(side * scale)));
  const canvas = new OffscreenCanvas(width ?? 1, height ?? 1);
  const context = canvas.getContext("2d");
  context?.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  bitmap.close();
  return context ? pictureOf(context.getImageData(0, 0, canvas.width, canvas.height)) : null;
}

/** Undefined while the picture is being read. */
export function usePicture(file: File | null): Picture | null | undefined {
  const [read, setRead] = useState<{ file: File; picture: Picture | null } | null>(null);
  useEffect(() => {
    let gone = false;
    if (file) void decode(file).then((picture) => !gone && setRead({ file, picture }));
    return () => {
      gone = true;
    };
  }, [file]);
  return read && read.file === file ? read.picture : undefined;
}
