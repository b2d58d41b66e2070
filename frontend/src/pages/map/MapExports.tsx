/** The site's floor in a menu, in the forms that other programs read; what takes a while says so. */
import { Button, Menu } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { useMutation } from "@tanstack/react-query";
import { Download } from "lucide-react";
import { useTranslation } from "react-i18next";
import { api, ApiProblem } from "@/api/client";
import { problemText } from "@/shell/LoadProblem";
import styles from "./MapPage.module.css";

/** What the address of each form ends with; the map alone, and what is worked out of places and zones. */
const ENDINGS = { yaml: "yaml", pgm: "pgm", nav2: "nav2.zip", building: "building.yaml", lif: "lif.json" } as const;
type Form = keyof typeof ENDINGS;
const GROUPS: readonly { name: string; forms: readonly Form[] }[] = [
  { name: "ros", forms: ["yaml", "pgm"] },
  { name: "fleets", forms: ["nav2", "building", "lif"] },
];

function save(name: string, bytes: Uint8Array<ArrayBuffer>): void {
  const address = URL.createObjectURL(new Blob([bytes]));
  Object.assign(document.createElement("a"), { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 1000);
}

function useExport(slug: string) {
  const { t } = useTranslation();
  return useMutation({
    mutationFn: async (form: Form) => {
      const words = { form: t(`mapExport.form.${form}`) };
      const id = notifications.show({ loading: true, autoClose: false, message: t("mapExport.making", words) });
      try {
        save(`${slug}.${ENDINGS[form]}`, await api.bytes(`/sites/${slug}/map.${ENDINGS[form]}`));
        notifications.update({ id, loading: false, autoClose: 4000, message: t("mapExport.made", words) });
      } catch (error) {
        const isBusy = error instanceof ApiProblem && error.code === "too_many_exports";
        const message = isBusy ? t("mapExport.busy") : problemText(error, t("shell.problem.screen"));
        notifications.update({ id, loading: false, autoClose: 8000, color: "red", message });
      }
    },
  });
}

export function MapExports({ slug }: { slug: string }) {
  const { t } = useTranslation();
  const { mutate, isPending } = useExport(slug);
  return (
    <Menu position="bottom-end" width={330}>
      <Menu.Target>
        <Button
          variant="default"
          loading={isPending}
          title={t("mapExport.title")}
          classNames={{ label: styles.actionLabel ?? "", section: styles.actionIcon ?? "" }}
          leftSection={<Download size={16} aria-hidden="true" />}
        >
          {t("mapExport.title")}
        </Button>
      </Menu.Target>
      <Menu.Dropdown>
        {GROUPS.map(({ name, forms }) => [
          <Menu.Label key={name}>{t(`mapExport.${name}`)}</Menu.Label>,
          ...forms.map((form) => (
            <Menu.Item key={form} onClick={() => mutate(form)}>
              <span className={styles.form}>{t(`mapExport.form.${form}`)}</span>
              <span className={styles.formAbout}>{t(`mapExport.about.${form}`)}</span>
            </Menu.Item>
          )),
        ])}
      </Menu.Dropdown>
    </Menu>
  );
}
