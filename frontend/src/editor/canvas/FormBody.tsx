/** The fields of a panel: Enter settles one, Esc takes its change back, and both give the keyboard to the map. */
import {
  Fragment,
  type FocusEvent,
  type KeyboardEvent,
  type MouseEvent,
  type ReactNode,
  useEffect,
  useRef,
  useState,
} from "react";
import { flushSync } from "react-dom";
import { focusMap } from "../state/focus";
import { useOpenProgram } from "../state/context";
import { undoDownTo } from "../state/undoing";
import classes from "../panel.module.css";

export function FormBody({ children }: { children: ReactNode }) {
  const [round, setRound] = useState(0);
  const { takeBack, ...visit } = useVisit();
  const onKeyDown = (event: KeyboardEvent) => {
    if (!isField(event.target)) return;
    if (event.key === "Escape" && !isExpanded(event.target)) {
      event.preventDefault();
      event.stopPropagation();
      takeBack();
      // What was written and not stored goes with the fields, before one of them could store it while it is left.
      flushSync(() => setRound(round + 1));
      focusMap();
    }
    if (event.key === "Enter" && settles(event, event.target)) leaveUnlessMoved(event.target);
  };
  /** Options lie outside of the panel's box, and yet their presses come by here. */
  const onClick = (event: MouseEvent) => {
    const { activeElement } = document;
    const option = event.target instanceof Element && event.target.closest("[role=option]");
    if (option && isField(activeElement) && !takesSeveral(activeElement)) leaveUnlessMoved(activeElement);
  };
  return (
    // oxlint-disable-next-line jsx-a11y/no-static-element-interactions -- it hears what its fields hear
    <div className={classes.body} data-form onKeyDown={onKeyDown} onClick={onClick} {...visit}>
      <Fragment key={round}>{children}</Fragment>
    </div>
  );
}

/** From where a field gets the keyboard to where it gives it up: one entry to undo, which Esc takes back. */
function useVisit() {
  const { shared, t } = useOpenProgram();
  const begun = useRef<{ readonly field: EventTarget; readonly entries: number } | null>(null);
  useEffect(() => () => shared.visits.end(), [shared]);
  const onFocus = ({ target }: FocusEvent) => {
    if (begun.current?.field === target) return;
    begun.current = { field: target, entries: shared.undo.length };
    shared.visits.begin();
  };
  /** Whoever looks at another window is still in the field. */
  const onBlur = () => {
    if (!document.hasFocus()) return;
    begun.current = null;
    shared.visits.end();
  };
  const takeBack = () => {
    const entries = begun.current?.entries ?? Infinity;
    undoDownTo({ shared, t }, entries);
    begun.current = null;
    shared.visits.end();
    shared.awareness.setLocalStateField("editing", null);
  };
  return { onFocus, onBlur, takeBack };
}

function isField(target: EventTarget | null): target is HTMLInputElement | HTMLTextAreaElement {
  return target instanceof HTMLInputElement || target instanceof HTMLTextAreaElement;
}

function isExpanded(field: Element): boolean {
  return field.getAttribute("aria-expanded") === "true";
}

/** Enter that the field has used for something else does not settle: it opens a list, or adds one of several. */
function settles(event: KeyboardEvent, field: HTMLInputElement | HTMLTextAreaElement): boolean {
  if (event.nativeEvent.isComposing) return false;
  if (isExpanded(field)) return !takesSeveral(field);
  if (event.defaultPrevented || event.shiftKey) return false;
  if (field instanceof HTMLTextAreaElement) event.preventDefault();
  return true;
}

function takesSeveral(field: Element): boolean {
  return field.closest("[data-several]") !== null;
}

/** After what the key or the press has changed is drawn; a field that has passed the keyboard on keeps it so. */
function leaveUnlessMoved(field: Element): void {
  queueMicrotask(() => {
    if (document.activeElement === field) focusMap();
  });
}
