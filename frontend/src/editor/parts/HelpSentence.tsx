/** One sentence at a time: what to do next with the tool in hand. */
import { useGestures } from "../gestures/store";
import { ZONE_TOOL } from "../state/tools";
import { useOpenProgram } from "../state/context";
import { askOf, type Ask, type Gesture } from "../state/tool";
import { useUi } from "../state/ui";
import classes from "./float.module.css";

export function HelpSentence() {
  const { t } = useOpenProgram();
  const gesture = useUi((ui) => ui.gesture);
  const into = useUi((ui) => ui.into);
  const pick = useUi((ui) => ui.fieldPick);
  const ask = askOf(gesture);
  const corners = useGestures((ui) => ui.corners.length);
  const text = pick
    ? t("help.field")
    : gesture.tool === ZONE_TOOL
      ? t(corners > 0 ? "gesture.zone.help_more" : "gesture.zone.help_first")
      : ask === "nothing" || ask === "load" || ask === "function"
        ? into
          ? t("help.into", { branch: into.word })
          : null
        : t(`help.${sentenceOf(ask, gesture)}`);
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
