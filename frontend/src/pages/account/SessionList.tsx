/** Where one is signed in, each to be ended by itself. */
import { Button } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { useRef } from "react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import { keys, useMySessions } from "@/api/queries";
import type { OwnSession } from "@/api/types";
import { Chip } from "@/design/Chip";
import { useNow } from "@/design/useNow";
import { formatAgo, formatMoment } from "@/i18n/format";
import { LoadProblem } from "@/shell/LoadProblem";
import { tellRefusal } from "@/shell/refusal";
import styles from "./account.module.css";

function useName(session: OwnSession): string {
  const { t } = useTranslation();
  const { browser, system } = session;
  if (browser && system) return t("pages.account.on", { browser, system });
  return browser || system || t("pages.account.unknown");
}

function Session({ session, now, onEnded }: { session: OwnSession; now: number; onEnded: () => void }) {
  const { t } = useTranslation();
  const queries = useQueryClient();
  const name = useName(session);
  const when = formatMoment(session.begun_at);
  const end = useMutation({
    mutationFn: () => api.delete(`/me/sessions/${session.id}`),
    onSuccess: () => {
      queries.setQueryData<OwnSession[]>(keys.mySessions, (all) => all?.filter((each) => each.id !== session.id));
      onEnded();
    },
    onError: (error) => {
      // One that has ended meanwhile is not there any more: the list says so.
      if (!(error instanceof ApiProblem && error.status === 404)) tellRefusal(error, t);
      void queries.invalidateQueries({ queryKey: keys.mySessions });
    },
  });
  return (
    <li className={styles.session}>
      <div>
        <strong>{name}</strong>
        {session.here ? <Chip tone="done">{t("pages.account.here")}</Chip> : null}
        <p>
          {t("pages.account.begun", { when })}
          {session.here ? null : `, ${t("pages.account.seen", { ago: formatAgo(session.seen_at, now) })}`}
        </p>
      </div>
      {session.here ? null : (
        <Button
          variant="default"
          size="xs"
          aria-label={t("pages.account.endNamed", { what: name, when })}
          loading={end.isPending}
          onClick={() => end.mutate()}
        >
          {t("pages.account.end")}
        </Button>
      )}
    </li>
  );
}

/** `ending`: all of them are about to end, so there is nothing more to ask for. */
export function SessionList({ ending }: { ending: boolean }) {
  const { t } = useTranslation();
  const sessions = useMySessions(ending);
  const now = useNow(30_000);
  const heading = useRef<HTMLHeadingElement>(null);
  return (
    <>
      <div>
        <h2 ref={heading} tabIndex={-1} id="own-sessions">
          {t("pages.account.sessions")}
        </h2>
        <p>{t("pages.account.sessionsText")}</p>
      </div>
      {sessions.isLoadingError ? <LoadProblem error={sessions.error} again={() => void sessions.refetch()} /> : null}
      <ul className={styles.sessions} aria-labelledby="own-sessions">
        {(sessions.data ?? []).map((session) => (
          <Session key={session.id} session={session} now={now} onEnded={() => heading.current?.focus()} />
        ))}
      </ul>
    </>
  );
}
