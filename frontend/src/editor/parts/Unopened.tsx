/** In the place of a program that is not here yet: that it comes, that the server is away, or why it is not opened. */
import { Button, Loader } from "@mantine/core";
import { CloudOff } from "lucide-react";
import { useEffect, useState, useSyncExternalStore } from "react";
import { Link } from "react-router-dom";
import classes from "../canvas/float.module.css";
import type { Saving } from "../shared/sharedProgram";
import { useOpenProgram } from "../state/context";

/** An opening that is quicker than this needs no words. */
const PATIENCE_MS = 400;
const REFUSALS: Readonly<Record<number, string>> = { 4401: "signed_out", 4403: "gone", 4404: "gone", 4429: "many" };

type Reason = "coming" | "away" | "signed_out" | "gone" | "many" | "refused";

/** Why a program is not here. */
export function unopenedReason({ connection, closedWith }: Pick<Saving, "connection" | "closedWith">): Reason {
  if (connection === "refused") return (REFUSALS[closedWith ?? 0] as Reason | undefined) ?? "refused";
  return connection === "reconnecting" ? "away" : "coming";
}

export function Unopened() {
  const { shared, loaded } = useOpenProgram();
  const saving = useSyncExternalStore(shared.subscribeSaving, shared.getSaving);
  const late = useLate();
  const reason = unopenedReason(saving);
  if (loaded || (reason === "coming" && !late)) return null;
  return <Panel reason={reason} />;
}

function Panel({ reason }: { reason: Reason }) {
  const { t, shared, site } = useOpenProgram();
  return (
    <section className={classes.empty} data-alone role={reason === "coming" ? "status" : "alert"}>
      <span className={classes.emptyIcon}>
        {reason === "coming" ? <Loader size={20} aria-hidden="true" /> : <CloudOff size={20} aria-hidden="true" />}
      </span>
      <h2>{t(`unopened.${reason}.title`)}</h2>
      {reason === "coming" ? null : <p>{t(`unopened.${reason}.text`)}</p>}
      {reason === "many" || reason === "refused" ? (
        <Button onClick={() => shared.connectAgain()}>{t("not_taken.again")}</Button>
      ) : null}
      {reason === "coming" || reason === "signed_out" ? null : (
        <Link className={classes.link} to={`/sites/${site.slug}/programs`}>
          {t("unopened.programs")}
        </Link>
      )}
    </section>
  );
}

function useLate(): boolean {
  const [late, setLate] = useState(false);
  useEffect(() => {
    const timer = setTimeout(() => setLate(true), PATIENCE_MS);
    return () => clearTimeout(timer);
  }, []);
  return late;
}
