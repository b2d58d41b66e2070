/** The short list at a point of the map: what the device there can do first, then all constructs, found by typing. */
import { useEffect, useLayoutEffect, useMemo, useRef, useState, type KeyboardEvent } from "react";
import { useTranslation } from "react-i18next";
import { useOtherLanguage } from "@/i18n/other";
import { keysOf, useKeymap } from "@/shell/keys/keymap";
import { rowPress } from "@/shell/palette/rowPress";
import { wordsOf } from "@/shell/palette/search";
import { type Drawable, drawablesAnywhere, drawablesOf } from "../commands/drawables";
import { toolId } from "../commands/drawing";
import { fitting } from "../commands/sentence";
import { commandOf } from "../commands/table";
import { useOpenProgram, type OpenProgram } from "../state/context";
import { focusMap } from "../state/focus";
import { underPointer } from "../state/under";
import { useUi, type QuickAdd as Where } from "../state/ui";
import classes from "./rail.module.css";

/** Its size, so that it stays on the screen. */
const SIZE = { width: 300, height: 340 };
const MARGIN = 8;

export function QuickAdd() {
  const open = useOpenProgram();
  const quick = useUi((ui) => ui.quick);
  useDoubleClick(open.canEdit);
  return quick && open.canEdit ? <List key={`${quick.x} ${quick.y}`} where={quick} /> : null;
}

function close(): void {
  useUi.setState({ quick: null });
  focusMap();
}

function List({ where }: { where: Where }) {
  const open = useOpenProgram();
  const { t } = useTranslation();
  const [text, setText] = useState("");
  const [at, setAt] = useState(0);
  const found = useDrawables(open, where.device, text);
  const box = useOwnFocus();
  const take = (drawable: Drawable | undefined) => {
    if (!drawable) return;
    useUi.setState({ quick: null });
    focusMap();
    drawable.draw(open, { step: null, link: null, device: where.device, at: where.at });
  };
  const press = (event: KeyboardEvent) => {
    if (event.key === "Enter") take(found[at]);
    else if (event.key === "ArrowDown") setAt(Math.min(found.length - 1, at + 1));
    else if (event.key === "ArrowUp") setAt(Math.max(0, at - 1));
    else if (event.key === "Escape") close();
    else return;
    event.preventDefault();
    event.stopPropagation();
  };
  return (
    <div
      ref={box}
      className={classes.quick}
      style={placeOf(where)}
      role="dialog"
      aria-label={t("commands.quick.label")}
    >
      <input
        value={text}
        role="combobox"
        aria-expanded="true"
        aria-controls="quick-add"
        aria-activedescendant={found[at] ? `quick-${at}` : undefined}
        aria-label={t("commands.quick.search")}
        placeholder={t("commands.quick.search")}
        onChange={(event) => {
          setText(event.target.value);
          setAt(0);
        }}
        onKeyDown={press}
      />
      <Found found={found} at={at} onTake={take} />
    </div>
  );
}

interface FoundProps {
  found: readonly Drawable[];
  at: number;
  onTake: (drawable: Drawable) => void;
}

function Found({ found, at, onTake }: FoundProps) {
  const { t } = useTranslation();
  return (
    <ul id="quick-add" role="listbox" aria-label={t("commands.quick.label")}>
      {found.map((drawable, index) => (
        <Row
          key={drawable.id}
          id={`quick-${index}`}
          drawable={drawable}
          chosen={index === at}
          onTake={() => onTake(drawable)}
        />
      ))}
      {found.length === 0 ? <li className={classes.none}>{t("commands.quick.none")}</li> : null}
    </ul>
  );
}

function useDrawables(open: OpenProgram, deviceId: string | null, text: string): readonly Drawable[] {
  const other = useOtherLanguage();
  const all = useMemo(() => {
    const device = open.surroundings.devices.get(deviceId ?? "");
    return [...(device ? drawablesOf(device, other) : []), ...drawablesAnywhere(open, other)];
  }, [open, deviceId, other]);
  return useMemo(() => (text.trim() ? fitting(wordsOf(text), all) : all), [all, text]);
}

/** The field has the keyboard; a press elsewhere closes the list. */
function useOwnFocus() {
  const box = useRef<HTMLDivElement>(null);
  useLayoutEffect(() => box.current?.querySelector("input")?.focus({ preventScroll: true }), []);
  useEffect(() => {
    const press = (event: PointerEvent) => {
      if (event.target instanceof Node && !box.current?.contains(event.target)) useUi.setState({ quick: null });
    };
    window.addEventListener("pointerdown", press, { capture: true });
    return () => window.removeEventListener("pointerdown", press, { capture: true });
  }, []);
  return box;
}

function placeOf({ x, y }: Where): { left: number; top: number } {
  return {
    left: Math.max(MARGIN, Math.min(x, window.innerWidth - SIZE.width - MARGIN)),
    top: Math.max(MARGIN, Math.min(y, window.innerHeight - SIZE.height - MARGIN)),
  };
}

interface RowProps {
  id: string;
  drawable: Drawable;
  chosen: boolean;
  onTake: () => void;
}

function Row({ id, drawable, chosen, onTake }: RowProps) {
  const { icon: Icon, name, about, tool } = drawable;
  const key = useKeymap((keymap) => (tool ? keysOf(commandOf(toolId(tool)), keymap)[0] : undefined));
  return (
    <li
      id={id}
      role="option"
      aria-selected={chosen}
      ref={(row) => {
        if (chosen) row?.scrollIntoView({ block: "nearest" });
      }}
      {...rowPress(onTake)}
    >
      <span>
        <Icon size={18} />
      </span>
      <span className={classes.what}>
        <strong>{name}</strong>
        <span>{about}</span>
      </span>
      {key ? <kbd>{key}</kbd> : null}
    </li>
  );
}

/** Twice on the bare floor, or on a machine. On a step it opens the step. */
function useDoubleClick(canEdit: boolean): void {
  const open = useOpenProgram();
  useEffect(() => {
    const ask = (event: MouseEvent) => {
      const { gesture, dialog } = useUi.getState();
      const onMap = event.target instanceof Element && event.target.closest(".react-flow__pane, .react-flow__node");
      if (!canEdit || !onMap || dialog || gesture.tool !== "select") return;
      const under = underPointer(open, { x: event.clientX, y: event.clientY });
      if (!under || under.step !== null || under.link) return;
      const { at, device } = under;
      useUi.setState({ quick: { x: event.clientX, y: event.clientY, at, device }, device: null });
    };
    window.addEventListener("dblclick", ask);
    return () => window.removeEventListener("dblclick", ask);
  }, [open, canEdit]);
}
