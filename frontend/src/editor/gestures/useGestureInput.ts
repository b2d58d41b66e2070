/** The keys and the clipboard of the gestures, for as long as the editor is on the screen. */
import { useEffect } from "react";
import { useOpenProgram } from "../state/context";
import { useZoneKeys } from "../zones/drawing";
import { useClipboard } from "./clipboard";
import { useGestureKeys } from "./keys";
import { resetGestures } from "./store";

export function useGestureInput(): void {
  const open = useOpenProgram();
  useGestureKeys(open);
  useZoneKeys(open);
  useClipboard(open);
  useEffect(() => resetGestures, [open.program.id]);
}
