/** What was set aside and is settled: by whom, when and how; read when somebody opens it. */
import { useState } from "react";
import { useTranslation } from "react-i18next";
import { missing } from "@/api/failed";
import type { DeadLetter } from "@/api/types";
import { formatAgo } from "@/i18n/format";
import { LoadProblem, Waiting } from "@/shell/LoadProblem";
import pages from "../../pages.module.css";
import { Facts, Why } from "./LetterFacts";
import { MOST, useSettledLetters } from "./letters";
import { whatWords } from "./letterWords";
import styles from "./setAside.module.css";

function SettledLetter({ letter, now }: { letter: DeadLetter; now: number }) {
  const { t } = useTranslation();
  const ago = letter.settled_at ? formatAgo(letter.settled_at, now) : "";
  const how = letter.state === "retried" ? "retried" : "dropped";
  return (
    <li className={styles.letter}>
      <div className={styles.body}>
        <p className={pages.strong}>{whatWords(letter)}</p>
        <Facts letter={letter} now={now} />
        <p>{t(`operations.setAside.settled.${how}`, { by: letter.settled_by, ago })}</p>
      </div>
      <Why letter={letter} />
    </li>
  );
}

function Letters({ slug, now }: { slug: string; now: number }) {
  const { t } = useTranslation();
  const letters = useSettledLetters(slug);
  const problem = missing(letters);
  if (problem) return <LoadProblem error={problem} again={() => void letters.refetch()} />;
  if (!letters.data) return <Waiting />;
  const count = letters.data.length;
  return (
    <>
      {count === 0 ? <p className={styles.intro}>{t("operations.setAside.settled.none")}</p> : null}
      {count === MOST ? <p className={styles.intro}>{t("operations.setAside.settled.most", { count })}</p> : null}
      <ul>
        {letters.data.map((letter) => (
          <SettledLetter key={letter.id} letter={letter} now={now} />
        ))}
      </ul>
    </>
  );
}

export function Settled({ slug, now }: { slug: string; now: number }) {
  const { t } = useTranslation();
  const [isOpen, setOpen] = useState(false);
  return (
    <details className={styles.settled} onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>{t("operations.setAside.settled.title")}</summary>
      {isOpen ? <Letters slug={slug} now={now} /> : null}
    </details>
  );
}
