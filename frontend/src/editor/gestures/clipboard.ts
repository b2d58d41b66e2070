/** Copy, cut and paste: readable script on the system's clipboard, and beside it the steps as they were drawn. */
import { useEffect } from "react";
import { clippingOf } from "@/api/localCopies";
import { useKeymap } from "@/shell/keys/keymap";
import { clip, type Clipping, clippingFromText, clippingToText } from "../edits/clipping";
import { clippedScript } from "../script/clippedScript";
import { pasteClipping, removeSelected } from "../state/actions";
import type { OpenProgram } from "../state/context";
import { isTyping } from "../state/focus";
import type { Names } from "../state/putting";
import { type EditorUi, useUi } from "../state/ui";

/** From a menu: the system's clipboard may refuse, this browser's memory does not. */
export function copyToSystem(open: OpenProgram, cut: boolean): void {
  const text = takeSelected(open, cut);
  if (text !== null) void navigator.clipboard?.writeText(text).catch(() => undefined);
}

function takeSelected(open: OpenProgram, cut: boolean): string | null {
  const { document, apply, canEdit } = open;
  const { selected } = useUi.getState();
  if (selected.length === 0) return null;
  const clipping = clip(document, selected, open.program.id);
  const drawn = clippingToText(clipping);
  const text = scriptOf(open, clipping) ?? drawn;
  const names = namesOf(open);
  keepDrawn({ text, drawn, names });
  useUi.setState({ clipboard: { clipping, names } });
  if (cut && canEdit) removeSelected(document, apply, clipping.outer);
  return text;
}

/** Null while the script does not know the last changes: it would be of other steps. */
function scriptOf({ compiled, shared }: OpenProgram, clipping: Clipping): string | null {
  const { waiting, connection } = shared.getSaving();
  if (!compiled?.script || waiting > 0 || connection !== "live") return null;
  const kinds = clipping.outer.map((id) => clipping.steps[id]?.kind);
  // An event has a function of its own in the script, and a comment is none of its lines.
  if (kinds.includes("on_event") || kinds.includes("comment")) return null;
  return clippedScript({ script: compiled.script, lines: compiled.lines }, clipping.outer);
}

function namesOf({ devices, plan }: OpenProgram): Names {
  return Object.fromEntries([...devices, ...(plan?.places ?? [])].map(({ id, name }) => [id, name]));
}

/** How the steps of a text were drawn, for this browser's other windows: script alone does not say where steps stand. */
interface Kept {
  readonly text: string;
  readonly drawn: string;
  readonly names: Names;
}

/** Each person's own: it goes when they sign out. */
function placeOfKept(): string {
  return clippingOf(useKeymap.getState().person ?? "");
}

function keepDrawn(kept: Kept): void {
  try {
    localStorage.setItem(placeOfKept(), JSON.stringify(kept));
  } catch {
    // Too much for the browser's store: the text is on the clipboard all the same.
  }
}

function readKept(): string | null {
  try {
    return localStorage.getItem(placeOfKept());
  } catch {
    return null;
  }
}

type Copied = EditorUi["clipboard"];

/** What was drawn as this text, if it was copied in this browser. */
export function drawnAs(text: string, kept: string | null): Copied {
  const direct = clippingFromText(text);
  if (direct) return { clipping: direct, names: {} };
  return drawnIn(kept, (copied) => copied.trim() === text.replaceAll("\r\n", "\n").trim());
}

function drawnIn(kept: string | null, isMeant: (text: string) => boolean): Copied {
  try {
    const found = JSON.parse(kept ?? "null") as Kept | null;
    const clipping = found && isMeant(found.text) ? clippingFromText(found.drawn) : null;
    return clipping ? { clipping, names: found?.names ?? {} } : null;
  } catch {
    return null;
  }
}

type PasteText = (open: OpenProgram, text: string) => boolean;

function putText(open: OpenProgram, text: string, pasteText: PasteText): void {
  const drawn = drawnAs(text, readKept());
  if (drawn) putCopied(open, drawn);
  else if (!pasteText(open, text)) putCopied(open, useUi.getState().clipboard);
}

function putCopied(open: OpenProgram, copied: Copied): void {
  if (copied) pasteClipping(open, copied.clipping, copied.names);
}

export function hasCopied(): boolean {
  return useUi.getState().clipboard !== null || readKept() !== null;
}

/**
 * What was copied here last, before this page was opened, too: from a menu the system's clipboard cannot be read
 * without asking.
 */
export function pasteCopied(open: OpenProgram): void {
  putCopied(open, useUi.getState().clipboard ?? drawnIn(readKept(), () => true));
}

/** The browser's own events of Ctrl+C, X and V, wherever no field has them; `pasteText` takes what is no clipping. */
export function useClipboard(open: OpenProgram, pasteText: PasteText): void {
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
      putText(open, event.clipboardData?.getData("text/plain") ?? "", pasteText);
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
