/** What floats over the map for a moment: a short word with Undo, and where the next step goes. */
import { CircleCheck, CircleQuestionMark, Settings2 } from "lucide-react";
import { useEffect, useSyncExternalStore } from "react";
import { IconButton } from "@/design/IconButton";
import classes from "../canvas/float.module.css";
import { useOpenProgram } from "../state/context";
import { useGestures } from "../state/gestures";
import { branchNow } from "../state/actions";
import { placeWords } from "../state/nextPlace";
import { type Ask, askOf, type Gesture } from "../state/tool";
import { ZONE_TOOL } from "../state/tools";
import { hideProgram, PROGRAM_BUTTON, useUi } from "../state/ui";
import { takeOffer } from "../state/undoing";

const TOAST_MS = 6000;

export function Toast() {
  const open = useOpenProgram();
  const { t } = open;
  const { undo } = open.shared;
  const toast = useUi((ui) => ui.toast);
  const offer = toast?.offer ?? null;
  const next = useSyncExternalStore(undo.subscribe, () => offer && undo.next(offer.way));
  useEffect(() => {
    if (!toast) return;
    const timer = setTimeout(() => useUi.setState({ toast: null }), TOAST_MS);
    return () => clearTimeout(timer);
  }, [toast]);
  const stands = offer !== null && next === offer.entry;
  if (!toast || (offer?.asked && !stands)) return null; // a question that nobody can answer any more
  const Sign = offer?.asked ? CircleQuestionMark : CircleCheck;
  return (
    <div className={classes.toast} role="status">
      {offer ? <Sign size={16} aria-hidden="true" data-asks={offer.asked} /> : null}
      {toast.text}
      {stands ? (
        <button type="button" onClick={() => takeOffer(open, offer)}>
          {t(offer.way)}
        </button>
      ) : null}
    </div>
  );
}

export function ProgramButton({ small, shown }: { small: boolean; shown: boolean }) {
  const { t } = useOpenProgram();
  const selected = useUi((ui) => ui.selected.length > 0);
  if (selected || (shown && !small)) return null;
  return (
    <div className={classes.programButton}>
      <IconButton
        id={PROGRAM_BUTTON}
        label={t("program.show")}
        aria-expanded={shown}
        onClick={() => (shown ? hideProgram() : useUi.setState({ inspector: true, programSheet: true }))}
      >
        <Settings2 size={17} aria-hidden="true" />
      </IconButton>
    </div>
  );
}

export function HelpSentence() {
  const open = useOpenProgram();
  const { t } = open;
  const gesture = useUi((ui) => ui.gesture);
  useUi((ui) => ui.selected); // the next step goes where the selected one stands
  const into = useUi((ui) => ui.into);
  const pick = useUi((ui) => ui.fieldPick);
  const ask = askOf(gesture);
  const corners = useGestures((ui) => ui.corners.length);
  const place = placeWords(open, branchNow(open.document));
  const goes = place === null ? "" : t("help.into", { branch: place });
  const text = pick
    ? t("help.field")
    : gesture.tool === ZONE_TOOL
      ? t(corners > 0 ? "gesture.zone.help_more" : "gesture.zone.help_first")
      : ask === "nothing" || ask === "load" || ask === "function"
        ? into
          ? goes || t("help.into", { branch: into.word })
          : null
        : [t(`help.${sentenceOf(ask, gesture)}`), goes].filter(Boolean).join(". ");
  if (!text) return null;
  return (
    <output className={classes.help} aria-live="polite">
      {text}
    </output>
  );
}

function sentenceOf(ask: Ask, gesture: Gesture): string {
  if (ask === "target" && gesture.tool === "drop") return "drop_target";
  return ask === "floor" && gesture.byKeyboard ? "floor_key" : ask;
}
