/** Opens the palette that finds commands, programs, devices, places and pages; Ctrl+K. */
import { Search } from "lucide-react";
import { lazy, Suspense, useCallback, useEffect, useState } from "react";
import { useTranslation } from "react-i18next";
import { nameOfKeys } from "../keys/keyNames";
import { PALETTE } from "../keys/shellCommands";
import { useTypedAhead } from "../keys/typedAhead";
import { IconButton } from "@/design/IconButton";
import { useFetchLater } from "@/design/useFetchLater";
import styles from "../sidebar.module.css";

const loadPalette = () => import("./Palette");
const LOADS = [loadPalette];
const Palette = lazy(async () => ({ default: (await loadPalette()).Palette }));

export function PaletteButton({ slug, small = false }: { slug: string | undefined; small?: boolean }) {
  const { t } = useTranslation();
  const [opened, setOpened] = useState(false);
  const close = useCallback(() => setOpened(false), []);
  useFetchLater(LOADS);
  useTypedAhead(opened, close);
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
      {small ? (
        <IconButton label={t("shell.jump.open")} aria-keyshortcuts="Control+K" onClick={() => setOpened(true)}>
          <Search size={17} aria-hidden="true" />
        </IconButton>
      ) : (
        <button type="button" className={styles.jump} aria-keyshortcuts="Control+K" onClick={() => setOpened(true)}>
          <Search size={16} aria-hidden="true" />
          <span className={styles.word}>{t("shell.jump.open")}</span>
          <kbd className={styles.wide} aria-hidden="true">
            {t("shell.jump.key")}
          </kbd>
        </button>
      )}
      <Suspense fallback={null}>{opened ? <Palette slug={slug} onClose={close} /> : null}</Suspense>
    </>
  );
}
