/** Which of the chosen files is the map's header and which its image; or an archive of both, a picture, or a drawing. Pure. */
export interface MapFiles {
  readonly yaml: File | null;
  readonly image: File | null;
  readonly archive: File | null;
  readonly drawing: File | null;
}

export const NO_FILES: MapFiles = { yaml: null, image: null, archive: null, drawing: null };

/** Whether a file can be a map or a part of one; a building file of RMF, also YAML, is none. */
export const isUsable = ({ name }: File): boolean =>
  /\.(zip|dxf|ya?ml|pgm|png|bmp|jpe?g|webp)$/i.test(name) && !/\.building\.ya?ml$/i.test(name);

/** Put newly chosen files beside those that are there; an archive or a drawing stands for all; other kinds are left out. */
export function sortFiles(known: MapFiles, chosen: readonly File[]): MapFiles {
  let { yaml, image } = known;
  for (const file of chosen.filter(isUsable)) {
    if (/\.zip$/i.test(file.name)) return { ...NO_FILES, archive: file };
    if (/\.dxf$/i.test(file.name)) return { ...NO_FILES, drawing: file };
    if (/\.ya?ml$/i.test(file.name)) yaml = file;
    else image = file;
  }
  const isNew = yaml !== known.yaml || image !== known.image;
  return { yaml, image, archive: isNew ? null : known.archive, drawing: isNew ? null : known.drawing };
}

/** What the chosen files are: a ROS map, a picture of a plan, a drawing, or not enough yet. */
export function kindOf({ yaml, image, archive, drawing }: MapFiles): "map" | "picture" | "drawing" | "none" {
  if (drawing) return "drawing";
  if (archive ?? yaml) return "map";
  return image && !/\.pgm$/i.test(image.name) ? "picture" : "none";
}

/** A name for the site out of the header's file name: `packing_hall.yaml` becomes `Packing hall`. */
export function nameFrom(file: string): string {
  const words = file
    .replace(/\.\w+$/, "")
    .replace(/[-_.]+/g, " ")
    .trim();
  return words.charAt(0).toUpperCase() + words.slice(1);
}
