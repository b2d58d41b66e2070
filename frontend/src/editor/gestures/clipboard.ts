/** Copy, cut and paste: in this browser's memory and on the system's clipboard, so that other windows take it, too. */
import { useEffect } from "react";
import { clip, clippingFromText, clippingToText } from "../edits/clipping";
import { copySelected, pasteCopied, putCopies, removeSelected } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { isTyping } from "../state/focus";
import { useUi } from "../state/ui";

/** From a menu: the system's clipboard may refuse, this browser's memory does not. */
export function copyToSystem(open: OpenProgram, cut: boolean): void {
  const text = takeSelected(open, cut);
  if (text !== null) void navigator.clipboard?.writeText(text).catch(() => undefined);
}

function takeSelected({ document, apply, canEdit }: OpenProgram, cut: boolean): string | null {
  const { selected } = useUi.getState();
  if (selected.length === 0) return null;
  const text = clippingToText(clip(document, selected));
  copySelected(document);
  if (cut && canEdit) removeSelected(document, apply);
  return text;
}

/** The browser's own events of Ctrl+C, X and V, wherever no field has them; `pasteText` takes what is no clipping. */
export function useClipboard(open: OpenProgram, pasteText: (open: OpenProgram, text: string) => boolean): void {
  useEffect(() => {
    const take = (event: ClipboardEvent) => {
      if (isElsewhere(event.target)) return;
      const text = takeSelected(open, event.type === "cut");
      if (text === null) return;
      event.clipboardData?.setData("text/plain", text);
      event.preventDefault();
    };
    const put = (event: ClipboardEvent) => {
      if (isElsewhere(event.target) || !open.canEdit) return;
      const text = event.clipboardData?.getData("text/plain") ?? "";
      const clipping = clippingFromText(text);
      if (clipping) putCopies(open.document, open.apply, clipping);
      else if (!pasteText(open, text)) pasteCopied(open.document, open.apply);
      event.preventDefault();
    };
    window.addEventListener("copy", take);
    window.addEventListener("cut", take);
    window.addEventListener("paste", put);
    return () => {
      window.removeEventListener("copy", take);
      window.removeEventListener("cut", take);
      window.removeEventListener("paste", put);
    };
  }, [open, pasteText]);
}

/** In a field, a dialog, or over text that somebody marked. */
function isElsewhere(target: EventTarget | null): boolean {
  const marked = window.getSelection()?.toString() ?? "";
  return useUi.getState().dialog !== null || isTyping(target) || marked !== "";
}
