/** The map that is being changed, its undo and redo, and the line that was measured on it. */
import { useState } from "react";
import type { CellMap } from "@/map/floor/rosFiles";
import type { Point } from "@/map/plane/projection";
import { begin, change, redo, undo, type Edits } from "./history";
import { applyStroke, type Settings } from "./tools";

const NO_LINE: readonly Point[] = [];

export function useEdits(base: CellMap) {
  const [edits, setEdits] = useState<Edits>(() => begin(base));
  const [measured, setMeasured] = useState(NO_LINE);
  /** The line was measured on the map as it lay: it goes when the map may lie otherwise. */
  const lay = (next: (last: Edits) => Edits) => {
    setMeasured(NO_LINE);
    setEdits(next);
  };
  return {
    edits,
    /** Both ends of the measured line, in metres; none where nothing is measured of the map as it lies. */
    measured,
    /** What a stroke of the tool in hand does. */
    finish: (settings: Settings, stroke: readonly Point[]) => {
      if (settings.tool === "measure") return setMeasured(stroke);
      const put = settings.tool === "crop" ? lay : setEdits;
      put((last) => change(last, applyStroke(last.now, settings, stroke)));
    },
    /** Go on with a map that lies as this one does. */
    change: (map: CellMap) => setEdits((last) => change(last, map)),
    /** Go on with a map that is scaled or turned. */
    changeLie: (map: CellMap) => lay((last) => change(last, map)),
    undo: () => lay(undo),
    redo: () => lay(redo),
  };
}
