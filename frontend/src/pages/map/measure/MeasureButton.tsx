/** Begins and ends measuring on the map, for everybody who sees it; M. */
import { Button } from "@mantine/core";
import { Ruler } from "lucide-react";
import { useEffect } from "react";
import { useTranslation } from "react-i18next";
import { useMe } from "@/api/queries";
import { openKeymap, useKeymap } from "@/shell/keys/keymap";
import page from "../MapPage.module.css";
import { usePageKey } from "../usePageKey";

/** The id of the button, where the focus is when measuring ends. */
export const MEASURE_BUTTON = "measure-button";

export function MeasureButton({ isOn, toggle }: { isOn: boolean; toggle: () => void }) {
  const { t } = useTranslation();
  const person = useMe().data?.user?.id;
  useEffect(() => {
    if (person !== undefined) openKeymap(String(person));
  }, [person]);
  const hasLetters = useKeymap(({ characters }) => characters); // who dictates has none
  usePageKey("m", toggle, hasLetters);
  return (
    <Button
      id={MEASURE_BUTTON}
      variant={isOn ? "filled" : "default"}
      aria-pressed={isOn}
      aria-keyshortcuts={hasLetters ? "M" : undefined}
      title={t(hasLetters ? "measure.withKey" : "measure.measure")}
      classNames={{ label: page.actionLabel ?? "", section: page.actionIcon ?? "" }}
      leftSection={<Ruler size={16} aria-hidden="true" />}
      onClick={toggle}
    >
      {t("measure.measure")}
    </Button>
  );
}
