/** What somebody has chosen as a map: its files, and how a picture is to be read. */
import { useState } from "react";
import type { MapSource } from "@/api/siteMaps";
import { rosForm } from "@/map/floor/rosFiles";
import { kindOf, NO_FILES, sortFiles, type MapFiles } from "./files";
import { mapFromPicture, pixelSize, type Picture, type PlanReading } from "./plan/picture";
import { firstReading } from "./plan/PlanFields";
import { usePicture } from "./plan/usePicture";

export interface MapChoice {
  files: MapFiles;
  choose: (chosen: readonly File[]) => MapFiles;
  /** Null unless the chosen file is a picture that can be read. */
  picture: Picture | null;
  /** Whether the chosen picture cannot be read. */
  isUnreadable: boolean;
  reading: PlanReading | null;
  read: (reading: PlanReading) => void;
  isReady: boolean;
  source: MapSource;
  makeForm: () => FormData;
}

function filesForm({ yaml, image, archive }: MapFiles): FormData {
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

export function useMapChoice(): MapChoice {
  const [files, setFiles] = useState<MapFiles>(NO_FILES);
  const kind = kindOf(files);
  const picture = usePicture(kind === "picture" ? files.image : null);
  const [kept, keep] = useState<{ of: Picture; reading: PlanReading } | null>(null);
  const reading = picture ? (kept?.of === picture ? kept.reading : firstReading(picture)) : null;
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
    read: (next) => picture && keep({ of: picture, reading: next }),
    isReady: kind === "map" || (reading !== null && pixelSize(reading) !== null),
    source: kind === "picture" ? "picture" : "upload",
    makeForm: () => {
      const map = picture && reading ? mapFromPicture(picture, reading) : null;
      return map ? rosForm(map) : filesForm(files);
    },
  };
}
