/** Which of the chosen files is the map's header and which its image. Pure. */
export interface MapFiles {
  readonly yaml: File | null;
  readonly image: File | null;
}

/** Put newly chosen files beside those that are there; files of other kinds are left out. */
export function sortFiles(known: MapFiles, chosen: readonly File[]): MapFiles {
  let { yaml, image } = known;
  for (const file of chosen) {
    if (/\.ya?ml$/i.test(file.name)) yaml = file;
    else if (/\.(pgm|png|bmp|jpe?g)$/i.test(file.name)) image = file;
  }
  return { yaml, image };
}

/** A name for the site out of the header's file name: `packing_hall.yaml` becomes `Packing hall`. */
export function nameFrom(file: string): string {
  const words = file
    .replace(/\.\w+$/, "")
    .replace(/[-_.]+/g, " ")
    .trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}
