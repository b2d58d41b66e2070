/** What somebody has chosen as a map: its files, and how a picture or a drawing is to be read. */
import { useDeferredValue, useMemo, useState } from "react";
import { useBroughtDrawing } from "@/api/broughtMaps";
import type { MapSource } from "@/api/siteMaps";
import { rosForm, type CellMap } from "@/map/floor/rosFiles";
import * as drawings from "./drawing/drawing";
import { kindOf, NO_FILES, sortFiles, type MapFiles } from "./files";
import { isTooLarge, mapFromPicture, planSize, type Picture, type PlanReading } from "./plan/picture";
import { firstReading } from "./plan/PlanFields";
import { usePicture } from "./plan/usePicture";

interface DrawingChoice {
  readonly drawing: drawings.Drawing;
  readonly reading: drawings.DrawingReading;
  readonly read: (reading: drawings.DrawingReading) => void;
  readonly map: CellMap | null;
}

export interface MapChoice {
  files: MapFiles;
  choose: (chosen: readonly File[]) => MapFiles;
  /** Null unless the chosen file is a picture that can be read. */
  picture: Picture | null;
  /** Whether the chosen picture cannot be read. */
  isUnreadable: boolean;
  reading: PlanReading | null;
  read: (reading: PlanReading) => void;
  /** Null unless the chosen file is a drawing that has been read. */
  drawn: DrawingChoice | null;
  /** Whether the server still reads a drawing, and why it could not. */
  isReading: boolean;
  refused: Error | null;
  isReady: boolean;
  source: MapSource;
  /** The map as cells, where the browser makes it itself. */
  makeMap: () => CellMap | null;
  makeForm: () => FormData;
}

export function filesForm({ yaml, image, archive }: MapFiles): FormData {
  const form = new FormData();
  for (const [name, file] of [
    ["yaml", yaml],
    ["image", image],
    ["archive", archive],
  ] as const)
    // prettier-ignore
    if (file) form.set(name, file);
  return form;
}

const SOURCES = { picture: "picture", drawing: "drawing", map: "upload", none: "upload" } as const;

function usePictureChoice(file: File | null) {
  const picture = usePicture(file);
  const [kept, keep] = useState<{ of: Picture; reading: PlanReading } | null>(null);
  const reading = picture ? (kept?.of === picture ? kept.reading : firstReading(picture)) : null;
  const read = (next: PlanReading) => picture && keep({ of: picture, reading: next });
  return { picture, reading, read };
}

function useDrawingChoice(site: string, file: File | null) {
  const { data = null, error, isFetching } = useBroughtDrawing(site, file);
  const [kept, keep] = useState<{ of: drawings.Drawing; reading: drawings.DrawingReading } | null>(null);
  const reading = useMemo(
    () => (data ? (kept?.of === data ? kept.reading : drawings.firstReading(data)) : null),
    [data, kept],
  );
  const settled = useDeferredValue(reading);
  const map = useMemo(() => (data && settled ? drawings.mapFromDrawing(data, settled) : null), [data, settled]);
  const drawn: DrawingChoice | null =
    file && data && reading ? { drawing: data, reading, read: (next) => keep({ of: data, reading: next }), map } : null;
  return { drawn, isReading: file !== null && isFetching, refused: file ? error : null };
}

/** `site` is where a drawing is read; a site that is still to be made takes none. */
export function useMapChoice(site = ""): MapChoice {
  const [files, setFiles] = useState<MapFiles>(NO_FILES);
  const kind = kindOf(files);
  const { picture, reading, read } = usePictureChoice(kind === "picture" ? files.image : null);
  const drawing = useDrawingChoice(site, site && kind === "drawing" ? files.drawing : null);
  const makeMap = () => (picture && reading ? mapFromPicture(picture, reading) : (drawing.drawn?.map ?? null));
  const size = picture && reading ? planSize(picture, reading) : null;
  return {
    files,
    choose: (chosen) => {
      const sorted = sortFiles(files, chosen);
      setFiles(sorted);
      return sorted;
    },
    picture: picture ?? null,
    isUnreadable: kind === "picture" && picture === null,
    reading,
    read,
    ...drawing,
    isReady: kind === "map" || Boolean(drawing.drawn?.map) || (size !== null && !isTooLarge(size)),
    source: SOURCES[kind],
    makeMap,
    makeForm: () => {
      const map = makeMap();
      return map ? rosForm(map) : filesForm(files);
    },
  };
}
