/** Opens the palette that finds programs, devices and pages; Ctrl+K. */
import { Search } from "lucide-react";
import { lazy, Suspense, useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { nameOfKeys } from "./keys/keyNames";
import { PALETTE } from "./keys/shellCommands";
import styles from "./sidebar.module.css";

const JumpPalette = lazy(async () => ({ default: (await import("./JumpPalette")).JumpPalette }));

export function JumpButton({ slug }: { slug: string | undefined }) {
  const { t } = useTranslation();
  const [opened, setOpened] = useState(false);
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      if (!PALETTE.keys.includes(nameOfKeys(event))) return;
      event.preventDefault();
      setOpened(true);
    };
    window.addEventListener("keydown", onKey);
    return () => window.removeEventListener("keydown", onKey);
  }, []);
  return (
    <>
      <button type="button" className={styles.jump} aria-keyshortcuts="Control+K" onClick={() => setOpened(true)}>
        <Search size={16} aria-hidden="true" />
        <span className={styles.word}>{t("shell.jump.open")}</span>
        <kbd className={styles.wide} aria-hidden="true">
          {t("shell.jump.key")}
        </kbd>
      </button>
      <Suspense fallback={null}>
        {opened ? <JumpPalette slug={slug} onClose={() => setOpened(false)} /> : null}
      </Suspense>
    </>
  );
}
