/** What could not be taken in at a site and was set aside, for admins: looked at, tried again, or dropped. */
import { notifications } from "@mantine/notifications";
import { useEffect, useRef, useState } from "react";
import { useTranslation } from "react-i18next";
import { useLocation } from "react-router-dom";
import { missing } from "@/api/failed";
import type { DeadLetter } from "@/api/types";
import { useNow } from "@/design/useNow";
import { SET_ASIDE } from "@/shell/findings/findings";
import { LoadProblem, problemText, Waiting } from "@/shell/LoadProblem";
import { NothingHere, Section } from "../../section/Section";
import { AskDrop } from "./AskDrop";
import { Letter } from "./Letter";
import { MOST, useOpenLetters, useSettle, type Settling } from "./letters";
import { Settled } from "./Settled";
import styles from "./setAside.module.css";

interface Dropping {
  letter: DeadLetter;
  from: HTMLElement;
}

/** Retries or drops, and says what came of it; a refusal stands until the next try. */
function useSettling(slug: string) {
  const { t } = useTranslation();
  const settle = useSettle(slug);
  const [refused, setRefused] = useState("");
  const send = (settling: Settling, onDone?: () => void) => {
    if (settle.isPending) return;
    setRefused("");
    settle.mutate(settling, {
      onSuccess: () => notifications.show({ message: t(`operations.setAside.done.${settling.what}`) }),
      onError: (error) => setRefused(problemText(error, t("shell.problem.screen"))),
      onSettled: onDone,
    });
  };
  return { send, refused, under: settle.isPending ? settle.variables : undefined };
}

/** Who comes by the link of an alert finds the focus at this section. */
function useArrival(heading: () => HTMLElement | null) {
  const { hash, key } = useLocation();
  const find = useRef(heading);
  useEffect(() => {
    if (hash !== `#${SET_ASIDE}`) return;
    const there = find.current();
    there?.scrollIntoView({ block: "center" });
    there?.focus({ preventScroll: true });
  }, [hash, key]);
}

export function SetAside({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const letters = useOpenLetters(slug);
  const [dropping, setDropping] = useState<Dropping | null>(null);
  const { send, refused, under } = useSettling(slug);
  const now = useNow(15_000);
  const heading = useRef<HTMLHeadingElement>(null);
  const toHeading = () => heading.current;
  useArrival(toHeading);
  const { data } = letters;
  const problem = missing(letters);
  const close = () => setDropping(null);
  return (
    <Section
      title={t("operations.setAside.title")}
      count={data?.length}
      remark={data?.length === MOST ? t("operations.setAside.most", { count: MOST }) : undefined}
      heading={heading}
    >
      {refused ? (
        <p className={styles.refused} role="alert">
          {refused}
        </p>
      ) : null}
      {problem ? <LoadProblem error={problem} again={() => void letters.refetch()} /> : null}
      {letters.isPending && !problem ? <Waiting /> : null}
      {data?.length === 0 ? <NothingHere>{t("operations.setAside.none")}</NothingHere> : null}
      {data?.length ? <p className={styles.intro}>{t("operations.setAside.intro")}</p> : null}
      <ul>
        {data?.map((letter) => (
          <Letter
            key={letter.id}
            letter={letter}
            now={now}
            retries={under?.what === "retry" && under.letter.id === letter.id}
            onRetry={() => send({ letter, what: "retry" })}
            onDrop={(from) => setDropping({ letter, from })}
            afterwards={toHeading}
          />
        ))}
      </ul>
      <Settled slug={slug} now={now} />
      {dropping ? (
        <AskDrop
          letter={dropping.letter}
          busy={under?.what === "drop"}
          onDrop={() => send({ letter: dropping.letter, what: "drop" }, close)}
          onClose={close}
          afterwards={() => (dropping.from.isConnected ? dropping.from : toHeading())}
        />
      ) : null}
    </Section>
  );
}
