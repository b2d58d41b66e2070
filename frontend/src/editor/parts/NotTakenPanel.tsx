/** What became of changes that the server did not take, or no longer takes, and what can be done with them. */
import { Button } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { CircleAlert } from "lucide-react";
import { useRef, useState } from "react";
import { useNavigate } from "react-router-dom";
import { keys } from "@/api/queries";
import type { ProgramDocument } from "@/program/document/document";
import { problemText } from "@/shell/LoadProblem";
import type { Reason } from "../shared/refusal";
import { useOpenProgram } from "../state/context";
import { download, fillProgram, makeProgram } from "../state/ownVersion";
import classes from "./notTaken.module.css";

export function NotTakenPanel({ reason, waiting }: { reason: Reason; waiting: number }) {
  const { t, shared, program, document, canEdit } = useOpenProgram();
  const [sure, setSure] = useState(false);
  const save = useSave();
  const discard = useDiscard(reason);
  const has = waiting > 0 || reason === "viewer";
  return (
    <section className={classes.panel} aria-labelledby="not-taken">
      <CircleAlert size={18} aria-hidden="true" />
      <div>
        <div role="alert">
          <h2 id="not-taken">{waiting > 0 ? t("not_taken.title", { count: waiting }) : t("not_taken.untold")}</h2>
          <p>{t(`not_taken.why.${reason}`)}</p>
        </div>
        {save.isError ? <p role="alert">{problemText(save.error, t("not_taken.failed"))}</p> : null}
        <div className={classes.buttons}>
          {has && canEdit ? (
            <Button size="xs" loading={save.isPending} onClick={() => save.mutate()}>
              {t("not_taken.save")}
            </Button>
          ) : null}
          {has ? (
            <Button size="xs" variant="default" onClick={() => download(program.name, document)}>
              {t("not_taken.download")}
            </Button>
          ) : null}
          {reason === "many" ? (
            <Button size="xs" variant="default" onClick={() => shared.connectAgain()}>
              {t("not_taken.again")}
            </Button>
          ) : null}
          {has ? (
            <Button
              size="xs"
              variant="default"
              color={sure ? "red" : undefined}
              loading={discard.isPending}
              onClick={() => (sure ? discard.mutate() : setSure(true))}
            >
              {t(sure ? "not_taken.discard_sure" : "not_taken.discard")}
            </Button>
          ) : null}
        </div>
      </div>
    </section>
  );
}

/** The copy here goes, and the program is opened as the server has it, if it still has it. */
function useDiscard(reason: Reason) {
  const { shared, site, openAnew } = useOpenProgram();
  const navigate = useNavigate();
  const leave = () => void navigate(`/sites/${site.slug}/programs`);
  return useMutation({ mutationFn: () => shared.discard(), onSuccess: reason === "gone" ? leave : openAnew });
}

/** A program of the same site from what is on this screen; then the copy here has done its work. */
function useSave() {
  const { t, shared, site, program } = useOpenProgram();
  const queries = useQueryClient();
  const navigate = useNavigate();
  const made = useRef<string | null>(null); // another try fills the program that the first one has made
  return useMutation({
    mutationFn: async () => {
      made.current ??= (await makeProgram(site.slug, t("not_taken.name", { name: program.name }).slice(0, 100))).id;
      // What is drawn meanwhile is a part of it, too.
      for (let sent: ProgramDocument | null = null; sent !== shared.getDocument();) {
        sent = shared.getDocument();
        await fillProgram(made.current, sent);
      }
      await shared.discard();
      return made.current;
    },
    onSuccess: (id) => {
      void queries.invalidateQueries({ queryKey: keys.programs(site.slug) });
      void navigate(`/programs/${id}`);
    },
  });
}
