/** What is saved of one's own changes. What others draw never changes what stands here. */
import { Cloud, CloudOff } from "lucide-react";
import { useSyncExternalStore } from "react";
import { Chip } from "@/design/Chip";
import type { Translate } from "@/program/words/stepWords";
import type { Saving } from "../shared/sharedProgram";
import { useOpenProgram } from "../state/context";
import classes from "./top.module.css";

export function SavedChip() {
  const { shared, t, loaded, canEdit } = useOpenProgram();
  const saving = useSyncExternalStore(shared.subscribeSaving, shared.getSaving);
  if (!loaded) return <Chip tone="plain">{t("unopened.chip")}</Chip>;
  if (!canEdit) return <Chip tone="plain">{t("read_only")}</Chip>;
  const state = stateOf(saving);
  const away = state !== "live";
  return (
    <Chip tone={state === "refused" ? "error" : away ? "note" : "plain"}>
      {away ? <CloudOff size={14} aria-hidden="true" /> : <Cloud size={14} aria-hidden="true" />}
      {/* For the first moment nothing is said: “Saved” would not be true yet, and another word would flicker. */}
      <span className={away ? undefined : classes.words}>
        <span className={isFresh(saving) ? classes.unsaid : undefined}>{savedWords(saving, t)}</span>
      </span>
      {/* Who listens hears when the connection goes and comes, not each change that is counted or saved. */}
      <span className="visually-hidden" role="status">
        {t(`saved.heard.${state}`)}
      </span>
    </Chip>
  );
}

function stateOf({ connection }: Saving): "live" | "away" | "refused" {
  if (connection === "refused" || connection === "live") return connection;
  return "away";
}

/** Something of one's own waits, not longer than a moment. */
function isFresh({ connection, waiting, late }: Saving): boolean {
  return connection === "live" && waiting > 0 && !late;
}

function savedWords(saving: Saving, t: Translate): string {
  const { waiting, kept, late } = saving;
  const state = stateOf(saving);
  if (state === "refused") return waiting > 0 ? t("saved.not_taken", { count: waiting }) : t("saved.refused");
  if (state === "away") return waiting > 0 && kept ? t("saved.waiting", { count: waiting }) : t("saved.away");
  return t(late ? "saved.saving" : "saved.saved");
}
